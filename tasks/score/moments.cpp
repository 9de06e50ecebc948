#include "tasks/score/moments.h"

#include "tasks/score/smoothness.h"
#include "tasks/score/sums.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

namespace tasks {
namespace {

constexpr std::size_t kStill_ticks = 100;
constexpr double kLetGo = 0.8; // of the limit, as in the event's own rule

struct Attempted {
    const ScoreState& score;
    const Progress& progress;
    const ScoreContext& context;
    Window window;

    std::size_t end() const { return window.first + window.count; }
    bool has(std::size_t tool, std::size_t i, std::uint8_t flags) const {
        return (score.flags[tool][i] & flags) == flags;
    }
    std::string_view role(int tool) const {
        return tool >= 0 ? role_name(context.role[static_cast<std::size_t>(tool)]) : "other";
    }
    std::size_t index(std::int64_t tick) const {
        const std::int64_t last = static_cast<std::int64_t>(score.tip_m[0].size()) - 1;
        return static_cast<std::size_t>(
            std::clamp<std::int64_t>(tick - score.first_tick, 0, std::max<std::int64_t>(0, last)));
    }
};

double force_until_let_go(const Attempted& a, const Event& event) {
    double most = event.value;
    const std::vector<float>& force_n = a.score.force_n[static_cast<std::size_t>(event.tool)];
    for (std::size_t i = a.index(event.tick); i < force_n.size(); ++i) {
        const auto now = static_cast<double>(force_n[i]);
        if (now < kLetGo * a.context.force_limit_n)
            break;
        most = std::max(most, now);
    }
    return most;
}

double seconds_unseen(const Attempted& a, const Event& event) {
    double seconds = event.value; // so far
    const auto tool = static_cast<std::size_t>(event.tool);
    for (std::size_t i = a.index(event.tick); i < a.end() && !a.has(tool, i, kInView); ++i)
        seconds += kTick_s;
    return seconds;
}

std::string wrong_tool(const Attempted& a, const Event& event) {
    const auto target = static_cast<std::size_t>(std::max<int>(0, event.target));
    const std::string point =
        event.target >= 0 ? fmt::format("point {}", target + 1) : std::string("a point");
    if (event.target < 0 || target >= a.context.ideal_role.size())
        return fmt::format("The {} tool touched {} of another tool.", a.role(event.tool), point);
    return fmt::format("The {} tool touched {}, which is for the {} tool.", a.role(event.tool),
                       point, role_name(a.context.ideal_role[target]));
}

Moment of_event(const Attempted& a, const Event& event) {
    Moment moment{event.tick, event.tool, event.place_m, std::string(event_name(event.kind)),
                  2.0,        {}};
    const std::string_view role = a.role(event.tool);
    if (event.kind == EventKind::over_force && event.tool >= 0) {
        const double most_n = force_until_let_go(a, event);
        moment.badness = 2.0 + most_n / a.context.force_limit_n;
        moment.text = fmt::format("The {} tool pressed with {:.1f} N. The limit is {:.1f} N.", role,
                                  most_n, a.context.force_limit_n);
    } else if (event.kind == EventKind::out_of_view && event.tool >= 0) {
        const double seconds = seconds_unseen(a, event);
        moment.badness = std::min(3.0, 1.0 + seconds);
        moment.text =
            fmt::format("The {} tool worked outside the picture for {:.1f} s.", role, seconds);
    } else if (event.kind == EventKind::wrong_role) {
        moment.text = wrong_tool(a, event);
    } else if (event.kind == EventKind::off_target) {
        moment.text = fmt::format("The {} tool touched the tissue in a wrong place.", role);
    } else if (event.kind == EventKind::path_left) {
        moment.text =
            fmt::format("The {} tool left the path by {:.0f} mm.", role, 1e3 * event.value);
    } else if (event.kind == EventKind::order_broken) {
        moment.text =
            fmt::format("The {} tool went on {:.0f} mm too far ahead.", role, 1e3 * event.value);
    } else {
        moment.text = fmt::format("The {} tool: {}.", role, moment.kind);
    }
    return moment;
}

void add_largest_force(const Attempted& a, std::vector<Moment>& found) {
    float most_n = 0.0F;
    std::size_t at = 0, by = 0;
    for (std::size_t t = 0; t < kTools; ++t)
        for (std::size_t i = a.window.first; i < a.end(); ++i)
            if (a.has(t, i, kTouching | kPresent) && a.score.force_n[t][i] > most_n)
                std::tie(most_n, at, by) = std::tuple(a.score.force_n[t][i], i, t);
    const double force_n = static_cast<double>(most_n);
    if (!a.context.forces_on || most_n <= 0.0F || force_n > a.context.force_limit_n)
        return; // over the limit is an event already
    const int tool = static_cast<int>(by);
    found.push_back(
        {a.score.first_tick + static_cast<std::int64_t>(at), tool, a.score.tip_m[by][at],
         "largest_force", force_n / a.context.force_limit_n,
         fmt::format("Largest force: the {} tool pressed with {:.2f} N.", a.role(tool), force_n)});
}

// The tool that moves or touches at sample i; kTools if all are still.
std::size_t busy_tool(const Attempted& a, std::size_t i) {
    for (std::size_t t = 0; t < kTools; ++t) {
        if (!a.has(t, i, kPresent))
            continue;
        const std::size_t before = i >= kStill_ticks ? i - kStill_ticks : 0;
        const double moved_m = glm::distance(a.score.tip_m[t][i], a.score.tip_m[t][before]);
        if (a.has(t, i, kTouching) || moved_m >= kMoving_mps * kStill_ticks * kTick_s)
            return t;
    }
    return kTools;
}

void add_hesitation(const Attempted& a, std::vector<Moment>& found) {
    std::size_t begin = a.window.first, longest = 0, from = 0, next = kTools;
    for (std::size_t i = a.window.first; i <= a.end(); ++i) {
        const std::size_t busy = i < a.end() ? busy_tool(a, i) : kTools;
        if (i < a.end() && busy == kTools)
            continue;
        if (i - begin > longest)
            std::tie(longest, from, next) = std::tuple(i - begin, begin, busy);
        begin = i + 1;
    }
    const double seconds = static_cast<double>(longest) * kTick_s;
    if (seconds < kHesitation_s)
        return;
    const int tool = next < kTools ? static_cast<int>(next) : -1;
    found.push_back({a.score.first_tick + static_cast<std::int64_t>(from), tool,
                     tool >= 0 ? a.score.tip_m[next][from] : glm::dvec3(0.0), "hesitation",
                     std::min(1.0, 0.1 * seconds),
                     fmt::format("No tool moved for {:.1f} s.", seconds)});
}

// Worst second first; in a second its worst; then in the order of time and tools.
void sort_by_second(std::vector<Moment>& found) {
    std::map<std::int64_t, double> second;
    for (const Moment& moment : found)
        second[moment.tick / 1000] += moment.badness;
    const auto rank = [&](const Moment& m) {
        return std::tuple(-second.at(m.tick / 1000), -m.badness, m.tick, m.tool);
    };
    std::sort(found.begin(), found.end(),
              [&](const Moment& a, const Moment& b) { return rank(a) < rank(b); });
    for (Moment& moment : found)
        moment.badness = second.at(moment.tick / 1000);
}

} // namespace

std::vector<Moment> worst_moments(const ScoreState& score, const Progress& progress,
                                  const ScoreContext& context, std::size_t count) {
    const Attempted a{score, progress, context, window_of(score, progress)};
    std::vector<Moment> found;
    for (const Event& event : progress.events)
        if (is_error(event.kind))
            found.push_back(of_event(a, event));
    if (a.window.moved) {
        add_largest_force(a, found);
        add_hesitation(a, found);
    }
    sort_by_second(found);
    std::vector<Moment> worst;
    for (Moment& moment : found) {
        const bool near = std::any_of(worst.begin(), worst.end(), [&](const Moment& other) {
            return std::abs(other.tick - moment.tick) < kMomentsApart_ticks;
        });
        if (!near && worst.size() < count)
            worst.push_back(std::move(moment));
    }
    return worst;
}

} // namespace tasks
