#include "sim/session/attempt.h"

#include "tasks/score/find_metrics.h"
#include "tasks/score/path_metrics.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr std::size_t kChunkTicks = 1000;
constexpr std::size_t kStepBins = 4096; // millinewtons

tasks::ScoreContext context_of(const Scene& scene, const tasks::Exercise& exercise,
                               const tasks::AttemptRow& row) {
    tasks::ScoreContext context;
    context.force_limit_n = exercise.force_limit_n;
    for (int i = 0; i < kTools; ++i)
        context.role[i] = scene.tool[i].role;
    for (const tasks::ExerciseTarget& target : exercise.target) {
        context.ideal_path_m.push_back(target.at_m);
        context.ideal_role.push_back(target.role);
    }
    context.target_radius_m = exercise.radius_m;
    context.forces_on = row.forces_on;
    return context;
}

double share(const std::vector<std::uint32_t>& histogram, double part) {
    std::uint64_t total = 0;
    for (const std::uint32_t n : histogram)
        total += n;
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < histogram.size(); ++i) {
        seen += histogram[i];
        if (static_cast<double>(seen) >= part * static_cast<double>(total))
            return double(i);
    }
    return 0.0;
}

} // namespace

Attempt::Attempt(const Scene& scene, const tasks::Exercise& exercise,
                 std::vector<tasks::Target> rest_targets, tasks::AttemptRow row,
                 tasks::Logbook* logbook)
    : exercise_(exercise), rest_targets_(std::move(rest_targets)), geometry_(make_haptics(scene)),
      row_(std::move(row)), logbook_(logbook), context_(context_of(scene, exercise, row_)),
      step_histogram_(kStepBins) {
    hash_.add_setup(row_);
}

void Attempt::add(const tasks::StepTrace& step) {
    waiting_.push_back(step);
}

void Attempt::add(const tasks::TickTrace& tick) {
    // the schedule: steps up to the adopted one become part of the attempt now, in order
    while (tick.adopted_step >= 0 && !waiting_.empty() &&
           waiting_.front().step <= tick.adopted_step) {
        const tasks::StepTrace& step = waiting_.front();
        tissue_ = {step.target_um, step.clear_rays, step.stress_pa, step.targets};
        if (!placed_)
            take_ideal_path(waiting_.front());
        hash_.add(waiting_.front());
        steps_.push_back(waiting_.front());
        waiting_.pop_front();
    }
    hash_.add(tick);
    ticks_.push_back(tick);
    seen_ = observe_trace(geometry_, tick, tissue_, rest_targets_);
    tasks::observe(progress_, exercise_, seen_);
    tasks::observe(score_, seen_);
    for (int i = 0; i < kTools; ++i) {
        const auto& now = tick.tool[i].force_mn;
        double square = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double step = now[axis] - last_force_mn_[i][axis];
            square += step * step;
        }
        last_force_mn_[i] = now;
        const double step_mn = std::sqrt(square);
        worst_step_mn_ = std::max(worst_step_mn_, step_mn);
        ++step_histogram_[std::min(kStepBins - 1, static_cast<std::size_t>(step_mn))];
    }
    if (ticks_.size() == kChunkTicks)
        flush_chunk();
}

// The first step finds the tissue at rest: its targets are where a perfect path would lead.
void Attempt::take_ideal_path(const tasks::StepTrace& first) {
    placed_ = true;
    for (std::size_t t = 0; t < context_.ideal_path_m.size(); ++t) {
        for (int axis = 0; axis < 3; ++axis) {
            context_.ideal_path_m[t][axis] = first.target_um[t][axis] * 1e-6;
        }
    }
}

void Attempt::add_event(const tasks::Event& event) {
    progress_.events.push_back(event);
}

void Attempt::flush_chunk() {
    if (ticks_.empty())
        return;
    std::vector<std::byte> bytes;
    if (logbook_ || keep_)
        bytes = tasks::encode_chunk(ticks_, steps_);
    if (logbook_) {
        logbook_->append_chunk(row_.id, ticks_.front().tick, bytes);
        const std::span<const tasks::Event> events(progress_.events);
        logbook_->append_events(row_.id, events.subspan(events_logged_));
        events_logged_ = events.size();
    }
    if (keep_)
        kept_.push_back(std::move(bytes));
    ticks_.clear();
    steps_.clear();
}

Attempt::Outcome Attempt::finish(const tasks::RigReport& rig) {
    Outcome out;
    flush_chunk();
    out.metrics = tasks::finish(score_, progress_, context_);
    const auto of_path = tasks::path_metrics(progress_, exercise_, row_.forces_on);
    out.metrics.insert(out.metrics.end(), of_path.begin(), of_path.end());
    const auto of_tubes = tasks::find_metrics(progress_, exercise_, row_.forces_on);
    out.metrics.insert(out.metrics.end(), of_tubes.begin(), of_tubes.end());
    for (const tasks::Event& event : progress_.events)
        hash_.add(event);
    for (const tasks::Metric& metric : out.metrics)
        hash_.add(metric);
    row_.log_sha256 = hash_.finish();
    row_.rig = rig;
    row_.rig.force_step_mn_max = worst_step_mn_;
    row_.rig.force_step_mn_p999 = share(step_histogram_, 0.999);
    row_.completed = progress_.complete;
    row_.valid = row_.rig.faults.empty();
    row_.ended = true;
    out.row = row_;
    out.profile = tasks::profile(out.metrics, exercise_.level, row_.completed && row_.valid);
    out.moments = tasks::worst_moments(score_, progress_, context_);
    out.chunks = std::move(kept_);
    out.events = progress_.events;
    if (logbook_) {
        const std::span<const tasks::Event> events(progress_.events);
        logbook_->append_events(row_.id, events.subspan(events_logged_));
        logbook_->end_attempt(row_.id, row_, out.metrics);
    }
    return out;
}

} // namespace sim
