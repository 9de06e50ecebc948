// tests/tissue/columns_bench.cpp
// A quadratic block pressed at three places: CPU time of its step and of the modes, sixteen columns
// side by side against one at a time in the same run, and how well rough columns answer.
//   tissue_columns_bench [cells_x cells_y cells_z [pressed_percent [poisson [repeats]]]]
#include "tests/tissue/quadratic_bodies.h"
#include "tests/tissue/touched_body.h"
#include "tissue/response/contact_basis.h"
#include "tissue/solver/quadratic_columns.h"
#include "tissue/solver/solid.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

using glm::dvec3;

namespace {

constexpr dvec3 kSize_m{0.1, 0.08, 0.04};
constexpr double kStep_s = 0.01, kDelta_m = 0.004;
constexpr double kRows = 3e-2; // relative residual of the columns of contact rows
constexpr int kPoints = 3;
using Block = std::vector<double>;

double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double least_ms(int repeats, const std::function<void()>& work) {
    double least = 1e9;
    for (int k = 0; k < repeats; ++k) {
        const double start = cpu_ms();
        work();
        least = std::min(least, cpu_ms() - start);
    }
    return least;
}

struct Scene {
    bodies::TouchedBlock block;
    tissue::Solid solid;
    std::array<tissue::BasisContact, kPoints> contact;
    tissue::ContactBasis basis;
    std::size_t n = 0;

    tissue::QuadraticSolid& body() { return std::get<tissue::QuadraticSolid>(solid); }
};

tissue::Material material(double poisson) {
    tissue::Material m = bodies::elastic(8e3, poisson);
    m.damping_mass_1ps = 4.0;
    m.damping_stiffness_s = 3e-3;
    return m;
}

Scene make_scene(const std::array<int, 3>& cells, double poisson) {
    const tissue::TetMesh mesh = tissue::box_mesh(kSize_m, cells, 0.15);
    const auto held = bodies::anchors(mesh, [](auto x) { return x.z < 1e-9; });
    tissue::ContactSurface skin = bodies::fine_top(mesh, kSize_m, 1.75 * kSize_m.x / cells[0]);
    tissue::Solid solid = tissue::make_solid(tissue::Tier::quadratic, {mesh, held, {}},
                                             material(poisson), dvec3(0.0), kStep_s);
    Scene s{{mesh, {}, std::move(skin)}, std::move(solid), {}, {}, 0};
    const auto n = tissue::unknowns(s.solid);
    s.n = static_cast<std::size_t>(n);
    s.basis = tissue::make_contact_basis(n);
    constexpr double kAt[kPoints][2] = {{0.043, 0.037}, {0.060, 0.041}, {0.051, 0.055}};
    for (int i = 0; i < kPoints; ++i) {
        const auto at = [&](double dx, double dy) {
            return bodies::on_top(s.block, kAt[i][0] + dx, kAt[i][1] + dy);
        };
        s.contact[i] = {at(0, 0),
                        {at(kDelta_m, 0), at(-kDelta_m, 0), at(0, kDelta_m), at(0, -kDelta_m)},
                        {0, 0, 1},
                        {1, 0, 0},
                        {0, 1, 0}};
    }
    return s;
}

// Rows x, y, z of the three places.
Block rows(Scene& s) {
    Block block(9 * s.n, 0.0);
    for (std::size_t j = 0; j < 9; ++j) {
        dvec3 d(0.0);
        d[static_cast<int>(j % 3)] = 1.0;
        add_row(tissue::dofs(s.solid), s.block.skin, s.contact[j / 3].centre, d, 1.0,
                {block.data() + j * s.n, s.n});
    }
    return block;
}

// Gauss without pivots: the matrices are positive definite.
std::vector<double> solve_small(std::vector<double> a, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t i = k + 1; i < n; ++i) {
            const double f = a[i * n + k] / a[k * n + k];
            for (std::size_t j = k; j < n; ++j)
                a[i * n + j] -= f * a[k * n + j];
            b[i] -= f * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j)
            b[k] -= a[k * n + j] * b[j];
        b[k] /= a[k * n + k];
    }
    return b;
}

double inner(const double* a, const double* b, std::size_t n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i)
        sum += a[i] * b[i];
    return sum;
}

struct Times {
    std::vector<double> step_ms, basis_ms;
};

// A step that takes the three places down by `down_m` and nowhere else, as contact would.
void press(Scene& s, const Block& row, double down_m, Times& times) {
    Block du(s.n), load(s.n, 0.0), answer = row;
    const double start = cpu_ms();
    free_motion(s.solid, true, {}, du);
    solve(s.solid, kRows, {}, answer, 9);
    std::vector<double> W(81), gap(9);
    for (std::size_t i = 0; i < 9; ++i) {
        gap[i] = (i % 3 == 2 ? -down_m : 0.0) - inner(&row[i * s.n], du.data(), s.n);
        for (std::size_t j = 0; j < 9; ++j)
            W[9 * i + j] = inner(&row[i * s.n], &answer[j * s.n], s.n);
    }
    const std::vector<double> f = solve_small(W, gap);
    for (std::size_t j = 0; j < 9; ++j) {
        for (std::size_t k = 0; k < s.n; ++k) {
            du[k] += f[j] * answer[j * s.n + k];
            load[k] += f[j] * row[j * s.n + k];
        }
    }
    const auto report = end_step(s.solid, load, 20e-6, du);
    const double middle = cpu_ms();
    auto& body = s.body();
    compute_contact_basis(body.model, s.block.skin, body.state, body.system, s.contact, s.basis);
    times.step_ms.push_back(middle - start);
    times.basis_ms.push_back(cpu_ms() - middle);
    if (report.inverted > 0 || s.basis.modes < 33)
        std::printf("  inverted %d, modes %d\n", report.inverted, s.basis.modes);
}

void print(const char* what, std::vector<double> v) {
    std::sort(v.begin(), v.end());
    const auto at = [&](double share) {
        return v[static_cast<std::size_t>(share * static_cast<double>(v.size() - 1) + 0.5)];
    };
    std::printf("%-44s p50 %7.3f  p90 %7.3f  p99 %7.3f  most %7.3f\n", what, at(0.5), at(0.9),
                at(0.99), at(1.0));
}

void time_parts(Scene& s, const Block& row, int repeats) {
    auto& b = s.body();
    Block x(33 * s.n), y(33 * s.n);
    for (std::size_t k = 0; k < x.size(); ++k)
        x[k] = row[k % row.size()];
    const auto column = [&](Block& v, int j) {
        return std::span<double>(v.data() + static_cast<std::size_t>(j) * s.n, s.n);
    };
    const auto pair = [&](const char* what, const std::function<void()>& one,
                          const std::function<void()>& all) {
        const double alone = least_ms(repeats, one), together = least_ms(repeats, all);
        std::printf("%-44s one at a time %7.3f  together %7.3f ms  ratio %5.2f\n", what, alone,
                    together, alone / together);
    };
    const auto solves = [&](const char* what, const tissue::QuadraticOptions& o, int columns) {
        pair(
            what,
            [&] {
                for (int j = 0; j < columns; ++j)
                    solve(b.model, o, column(x, j), b.system, column(y, j));
            },
            [&] {
                y = x;
                solve_columns(b.model, o, b.system, y, columns);
            });
    };
    solves("rows: 9 columns to 1e-3", {}, 9);
    solves("16 columns to 1e-3", {}, 16);
    solves("33 columns, one iteration", {.linear_tolerance = 1e-9, .max_linear = 1}, 33);
    pair(
        "K times 33 columns",
        [&] {
            for (int j = 0; j < 33; ++j)
                stiffness_product(b.model, column(x, j), b.system, column(y, j));
        },
        [&] { stiffness_products(b.model, x, 33, b.system, y); });
    pair(
        "M times 33 columns",
        [&] {
            for (int j = 0; j < 33; ++j)
                mass_product(b.model, column(x, j), b.system, column(y, j));
        },
        [&] { mass_products(b.model, x, 33, b.system, y); });
    std::printf("%-44s %7.3f ms\n", "preconditioner, 16 columns",
                least_ms(repeats, [&] { precondition_columns(b.model, b.system, y, 16); }));
    std::printf("%-44s %7.3f ms\n", "factor alone, 16 columns",
                least_ms(repeats, [&] { solve_block(b.system.single, b.system.block.ordered); }));
    const auto report = [&] {
        y = x;
        return solve_columns(b.model, {}, b.system, y, 9);
    }();
    std::printf("rows: %d iterations, residual %.1e; least det F %.3f\n", report.iterations,
                report.relative_residual, b.system.min_det_f);
}

// Columns of the basis by another solver: `solve` takes a block of columns in place.
Block raw_basis(Scene& s, const std::function<void(Block&, int)>& solver) {
    auto& b = s.body();
    const auto row = [&](const tissue::ContactPoint& at, const dvec3& d, Block& out) {
        out.resize(out.size() + s.n, 0.0);
        add_row(tissue::dofs(s.solid), s.block.skin, at, d, 1.0,
                {out.data() + out.size() - s.n, s.n});
    };
    Block first, star, all;
    for (const auto& c : s.contact) {
        for (const dvec3& d : {c.normal, c.tangent1, c.tangent2})
            row(c.centre, d, first);
        for (const auto& at : c.star)
            row(at, c.normal, star);
    }
    solver(first, 9);
    solver(star, 12);
    Block second(first.size()), third(3 * s.n);
    mass_products(b.model, first, 9, b.system, second);
    solver(second, 9);
    for (std::size_t c = 0; c < 3; ++c)
        mass_products(b.model, {&second[3 * c * s.n], s.n}, 1, b.system, {&third[c * s.n], s.n});
    solver(third, 3);
    for (const Block* part : {&first, &star, &second, &third})
        all.insert(all.end(), part->begin(), part->end());
    return all;
}

// M-orthonormal, by Gram and Schmidt, twice; what is less than 1e-6 of itself is dropped.
Block orthonormal(Scene& s, const Block& raw) {
    auto& b = s.body();
    Block q, mass_q, m(s.n);
    for (std::size_t j = 0; j < raw.size() / s.n; ++j) {
        Block v(raw.begin() + static_cast<std::ptrdiff_t>(j * s.n),
                raw.begin() + static_cast<std::ptrdiff_t>((j + 1) * s.n));
        mass_product(b.model, v, b.system, m);
        const double size2 = inner(v.data(), m.data(), s.n);
        for (int pass = 0; pass < 2; ++pass) {
            for (std::size_t k = 0; k < q.size() / s.n; ++k) {
                const double part = inner(&mass_q[k * s.n], v.data(), s.n);
                for (std::size_t i = 0; i < s.n; ++i)
                    v[i] -= part * q[k * s.n + i];
            }
        }
        mass_product(b.model, v, b.system, m);
        const double left2 = inner(v.data(), m.data(), s.n);
        if (!(left2 > 1e-12 * size2))
            continue;
        for (std::size_t i = 0; i < s.n; ++i) {
            q.push_back(v[i] / std::sqrt(left2));
            mass_q.push_back(m[i] / std::sqrt(left2));
        }
    }
    return q;
}

// h^T V (a M + c K)^-1 V^T h of a row h, K in V exactly.
double compliance_mpn(Scene& s, const Block& q, const double* h, double t_s) {
    auto& b = s.body();
    const std::size_t modes = q.size() / s.n;
    Block k(q.size());
    stiffness_products(b.model, q, static_cast<int>(modes), b.system, k);
    const auto& m = b.model.material;
    const double of_m = 1.0 / (t_s * t_s) + m.damping_mass_1ps / t_s,
                 of_k = 1.0 + m.damping_stiffness_s / t_s;
    std::vector<double> a(modes * modes), right(modes);
    for (std::size_t i = 0; i < modes; ++i) {
        right[i] = inner(&q[i * s.n], h, s.n);
        for (std::size_t j = 0; j < modes; ++j)
            a[i * modes + j] =
                0.5 * of_k *
                    (inner(&q[i * s.n], &k[j * s.n], s.n) + inner(&q[j * s.n], &k[i * s.n], s.n)) +
                (i == j ? of_m : 0.0);
    }
    const std::vector<double> y = solve_small(a, right);
    return inner(y.data(), right.data(), modes);
}

constexpr double kTimes_s[] = {1e-3, 1e-2, 1e3}; // the last: statics

// The compliances of all rows at the three times, exactly, where the body stands.
std::vector<double> exact_mpn(Scene& s, const Block& row) {
    auto& b = s.body();
    std::vector<double> out;
    for (const double t_s : kTimes_s) {
        auto system = make_system(b.model, t_s);
        auto state = b.state;
        for (std::size_t i = 0; i < state.velocity_mps.size(); ++i)
            state.velocity_mps[i] = state.gain_mps[i] = dvec3(0.0);
        linearize(b.model, state, system);
        Block x = row;
        const auto report =
            solve_columns(b.model, {.linear_tolerance = 1e-5, .max_linear = 400}, system, x, 9);
        std::printf("  exact at T = %g s: %d iterations, residual %.1e%s\n", t_s, report.iterations,
                    report.relative_residual, report.projected ? ", projected" : "");
        for (std::size_t j = 0; j < 9; ++j)
            out.push_back(inner(&row[j * s.n], &x[j * s.n], s.n));
    }
    return out;
}

void compare(Scene& s, const Block& row, const char* what, const std::vector<double>& exact,
             const Block& raw) {
    const Block q = orthonormal(s, raw);
    std::printf("  %-30s %2zu modes; off, %%, normal and tangential:", what, q.size() / s.n);
    for (std::size_t t = 0; t < 3; ++t) {
        double normal = 0.0, tangential = 0.0;
        for (std::size_t j = 0; j < 9; ++j) {
            const double off =
                100 * (compliance_mpn(s, q, &row[j * s.n], kTimes_s[t]) / exact[9 * t + j] - 1.0);
            double& worst = j % 3 == 2 ? normal : tangential;
            worst = std::abs(off) > std::abs(worst) ? off : worst;
        }
        std::printf("  %7.3f %7.3f", normal, tangential);
    }
    std::printf("\n");
}

// `state` linearised at rest where it stands, so that K is that of the shape.
void study(Scene& s, const Block& row) {
    auto& b = s.body();
    tissue::stop(s.solid);
    linearize(b.model, b.state, b.system);
    const std::vector<double> exact = exact_mpn(s, row);
    const auto iterations = [&](int most) {
        return [&s, most](Block& x, int columns) {
            auto& body = s.body();
            solve_columns(body.model, {.linear_tolerance = 1e-5, .max_linear = most}, body.system,
                          x, columns);
        };
    };
    std::printf("  at T = 1 ms, 10 ms, statics; basis made for steps of %g ms\n", 1e3 * kStep_s);
    compare(s, row, "preconditioner alone", exact, raw_basis(s, [&](Block& x, int columns) {
                precondition_columns(b.model, b.system, x, columns);
            }));
    for (const int most : {1, 2, 3, 5, 400}) {
        char name[64];
        std::snprintf(name, sizeof name, "%d iterations", most);
        compare(s, row, name, exact, raw_basis(s, iterations(most)));
    }
    const auto now = [&](const char* what) {
        compare(s, row, what, exact,
                Block(s.basis.shape.begin(),
                      s.basis.shape.begin() + static_cast<std::ptrdiff_t>(
                                                  s.n * static_cast<std::size_t>(s.basis.modes))));
    };
    if (s.basis.modes > 0)
        now("the basis of the last step");
}

} // namespace

int main(int argc, char** argv) {
    const auto given = [&](int i, double otherwise) {
        return argc > i ? std::atof(argv[i]) : otherwise;
    };
    const std::array<int, 3> cells{static_cast<int>(given(1, 5)), static_cast<int>(given(2, 4)),
                                   static_cast<int>(given(3, 2))};
    const double pressed_m = 1e-2 * given(4, 30) * kSize_m.z, poisson = given(5, 0.45);
    const int repeats = static_cast<int>(given(6, 20));
    Scene s = make_scene(cells, poisson);
    const Block row = rows(s);
    std::printf("%zu tets, %zu nodes, nu %g\n", s.body().model.mesh.tets.size(),
                s.body().model.mesh.rest_m.size(), poisson);
    std::printf("at rest\n");
    study(s, row);
    Times times;
    constexpr int kSteps = 60;
    for (int k = 0; k < kSteps; ++k)
        press(s, row, pressed_m / kSteps, times);
    for (int k = 0; k < kSteps; ++k) // and back and forth a little
        press(s, row, k % 20 < 10 ? 2e-4 : -2e-4, times);
    std::printf("pressed by %g mm, then shaken\n", 1e3 * pressed_m);
    print("step: free, rows, end, ms CPU", times.step_ms);
    print("basis of three contacts, ms CPU", times.basis_ms);
    std::vector<double> both = times.step_ms;
    for (std::size_t k = 0; k < both.size(); ++k)
        both[k] += times.basis_ms[k];
    print("step and basis, ms CPU", both);
    time_parts(s, row, repeats);
    study(s, row);
    return 0;
}
