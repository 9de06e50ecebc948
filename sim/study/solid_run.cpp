#include "sim/study/solid_run.h"

#include "sim/study/solid_methods.h"

#include <algorithm>
#include <ctime>
#include <fmt/format.h>
#include <numbers>
#include <optional>

namespace sim {
namespace {

using glm::dvec3;

constexpr double kSame = 1e-3; // of the tip's way: it stays

double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

// One model at work on one body.
template <typename Method> struct Bench {
    const SolidCase& work;
    const SolidBody& body;
    SolidResult& result;
    std::optional<Method> method{};

    // All are numbers, and nobody is a hundred lengths away.
    bool sane(const std::vector<dvec3>& x) const {
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!(glm::length(x[i] - body.rest_m[i]) < 100.0 * work.length_m))
                return false;
        return true;
    }

    bool punch() const { return work.press == SolidPress::punch; }

    void carry_punch(double depth_m) {
        for (std::size_t i = 0; i < body.punched.size(); ++i)
            if (body.punched[i] != 0)
                method->position_m()[i] = body.rest_m[i] + depth_m * body.load_direction;
    }

    // False, and why, if there is nothing to be written.
    bool take(double t_s, double load_n, double ms, const SolidEffort& effort) {
        const std::vector<dvec3>& x = method->position_m();
        if (!sane(x) || !effort.converged) {
            result.failure =
                fmt::format("{} at {} {:g}", sane(x) ? "not converged" : "exploded",
                            work.statics ? "load" : "t =", work.statics ? load_n : t_s);
            return false;
        }
        SolidRow row{.t_s = t_s, .tip_m = tip_of(body, x), .ms = ms, .effort = effort};
        row.force_n = punch() ? method->push_n() : load_n;
        row.depth_m = glm::dot(mean_of(body, x), body.load_direction);
        result.row.push_back(row);
        return true;
    }

    void run_steps() {
        std::vector<dvec3> before_mps;
        for (int i = 0; i < work.steps; ++i) {
            if (punch()) // comes down evenly
                carry_punch(work.depth_m[0] * (i + 1.0) / work.steps);
            before_mps = method->velocity_mps();
            const double start_ms = cpu_ms();
            SolidEffort effort = method->step();
            const double ms = cpu_ms() - start_ms;
            if (std::isnan(effort.residual))
                effort.residual = method->audit(before_mps);
            if (!take((i + 1) * work.dt_s, work.load_n[0], ms, effort))
                return;
        }
        result.settled = stayed(static_cast<std::size_t>(std::max(work.steps / 10, 1)));
    }

    // For the last `rows`, to 0.1 % of the tip's way.
    bool stayed(std::size_t rows) const {
        if (result.row.size() <= rows)
            return false;
        const dvec3 end = result.row.back().tip_m;
        return std::all_of(result.row.end() - static_cast<std::ptrdiff_t>(rows), result.row.end(),
                           [&](const SolidRow& r) {
                               return glm::length(r.tip_m - end) <= kSame * glm::length(end);
                           });
    }

    void run_statics() {
        const std::vector<double>& ways = punch() ? work.depth_m : work.load_n;
        double depth_m = 0.0;
        for (const double way : ways) {
            if (!punch())
                method->set_load_n(way);
            SolidEffort effort;
            const double start_ms = cpu_ms();
            // a punch that goes far at once turns the tets under it inside out
            const double part_m = 0.2 * work.height_m / work.cells[1];
            const int parts =
                punch() ? std::max(1, static_cast<int>(std::ceil(std::abs(way - depth_m) / part_m)))
                        : 1;
            for (int k = 1; k <= parts; ++k) {
                if (punch())
                    carry_punch(depth_m + (way - depth_m) * k / parts);
                effort = settle();
            }
            depth_m = way;
            if (!take(0.0, way, cpu_ms() - start_ms, effort))
                return;
        }
        result.settled = true;
    }

    SolidEffort settle() {
        if constexpr (Method::kStatics)
            return method->settle();
        else
            return come_to_rest();
    }

    // The quarter of a period in which the body first gathers most kinetic energy. The
    // model is then made anew, damped twice as much as that frequency: nothing comes to rest
    // sooner.
    void damp() {
        constexpr int kMostSteps = 200;
        double last = 0.0;
        int steps = 0;
        punch() ? carry_punch(0.1 * work.height_m / work.cells[1])
                : method->set_load_n(work.load_n[0]);
        for (; steps < kMostSteps; ++steps) {
            method->step();
            double energy = 0.0; // of unit masses
            for (const dvec3& v : method->velocity_mps())
                energy += glm::dot(v, v);
            if (!(energy > last))
                break;
            last = energy;
        }
        SolidCase damped = work;
        const double quarter_s = std::max(steps, 1) * work.dt_s;
        damped.material.damping_mass_1ps =
            std::max(work.material.damping_mass_1ps, std::numbers::pi / quarter_s);
        method.emplace(damped, body);
    }

    SolidEffort come_to_rest() {
        constexpr int kMostSteps = 4000, kStill = 100;
        dvec3 stood_m{0.0};
        SolidEffort sum{.converged = false};
        for (int i = 0, still = 0; i < kMostSteps && still < kStill; ++i) {
            const SolidEffort effort = method->step();
            sum.substeps += effort.substeps;
            sum.residual = effort.residual;
            if (!effort.converged || !sane(method->position_m()))
                return sum;
            const dvec3 tip = tip_of(body, method->position_m());
            const bool stays = glm::length(tip - stood_m) <= kSame * glm::length(tip);
            still = stays ? still + 1 : 0;
            stood_m = stays ? stood_m : tip;
            sum.converged = still >= kStill;
        }
        return sum;
    }

    void run() {
        if (work.statics && !Method::kStatics)
            damp();
        if (!punch())
            method->set_load_n(work.load_n[0]);
        work.statics ? run_statics() : run_steps();
    }
};

template <typename Method>
void run_with(const SolidCase& work, const SolidBody& body, SolidResult& result) {
    Bench<Method> bench{work, body, result};
    bench.method.emplace(work, body);
    bench.run();
}

double quantile(const std::vector<double>& ascending, double share) {
    return ascending[static_cast<std::size_t>(share * static_cast<double>(ascending.size() - 1) +
                                              0.5)];
}

template <typename Figure> double worst(const std::vector<SolidRow>& rows, Figure figure) {
    double out = kUnknown;
    for (const SolidRow& r : rows)
        out = std::fmax(out, figure(r)); // not a number only if all are
    return out;
}

std::string cell(double value) {
    return std::isnan(value) ? "" : fmt::format("{:.9g}", value);
}

} // namespace

SolidTimes SolidResult::ms() const {
    std::vector<double> values;
    SolidTimes out;
    for (const SolidRow& r : row) {
        values.push_back(r.ms);
        out.mean += r.ms / static_cast<double>(row.size());
    }
    if (values.empty())
        return out;
    std::ranges::sort(values);
    return {out.mean, quantile(values, 0.5), quantile(values, 0.99), values.back()};
}

int SolidResult::newton_iterations() const {
    int sum = 0;
    for (const SolidRow& r : row)
        sum += r.effort.newton;
    return sum;
}

int SolidResult::substeps() const {
    int sum = 0;
    for (const SolidRow& r : row)
        sum += r.effort.substeps;
    return sum;
}

int SolidResult::linear_iterations() const {
    int sum = 0;
    for (const SolidRow& r : row)
        sum += r.effort.linear;
    return sum;
}

double SolidResult::worst_residual() const {
    return worst(row, [](const SolidRow& r) { return r.effort.residual; });
}

double SolidResult::own_residual() const {
    const bool linear = model == "corotated" && !row.empty() && row.back().t_s > 0.0;
    return linear ? worst_linear_residual() : worst_residual();
}

double SolidResult::worst_linear_residual() const {
    return worst(row, [](const SolidRow& r) { return r.effort.linear_residual; });
}

SolidResult run_solid(const SolidCase& work) {
    const SolidBody body = make_solid_body(work);
    SolidResult result;
    result.model = work.model;
    result.nodes = body.rest_m.size();
    result.tets = body.tets();
    const bool quadratic = element_of(work) == SolidElement::quadratic;
    result.element = quadratic ? "p2" : "p1";
    if (work.model == "reference" || (work.model == "linear" && quadratic))
        run_with<ReferenceMethod>(work, body, result);
    else if (work.model == "linear")
        run_with<LinearMethod>(work, body, result);
    else if (work.model == "quadratic")
        run_with<QuadraticMethod>(work, body, result);
    else if (work.model == "corotated")
        run_with<CorotatedMethod>(work, body, result);
    else if (work.model == "mass-spring")
        run_with<BaselineMethod<tissue::MassSpringModel>>(work, body, result);
    else if (work.model == "xpbd")
        run_with<BaselineMethod<tissue::XpbdModel>>(work, body, result);
    else if (work.model == "tled")
        run_with<BaselineMethod<tissue::TledModel>>(work, body, result);
    else
        run_with<BaselineMethod<tissue::ProjectiveModel>>(work, body, result);
    return result;
}

std::string solid_csv(const SolidResult& result) {
    std::string out = "t_s,force_n,depth_m,tip_x_m,tip_y_m,tip_z_m,ms,newton,linear,substeps,"
                      "linear_residual,residual\n";
    for (const SolidRow& r : result.row)
        out += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{},{},{},{},{}\n",
                           r.t_s, r.force_n, r.depth_m, r.tip_m.x, r.tip_m.y, r.tip_m.z, r.ms,
                           r.effort.newton, r.effort.linear, r.effort.substeps,
                           cell(r.effort.linear_residual), cell(r.effort.residual));
    return out;
}

} // namespace sim
