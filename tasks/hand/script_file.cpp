// tasks/hand/script_file.cpp
// Bytes of a script -> Script, and the judgement of its expectations. Called by sim at set-up and
// after the attempt.
#include "tasks/exercise/toml_reader.h"
#include "tasks/hand/script.h"

#include <algorithm>
#include <numbers>
#include <sstream>

namespace tasks {
namespace {

constexpr Range kPlace_mm{-500.0, 500.0};
constexpr Range kForce_n{0.01, 20.0};
constexpr Range kSeconds{0.001, 3600.0};
constexpr Range kAny{-1e9, 1e9};

void accept_for(Verb verb, const TomlTable& t) {
    switch (verb) {
    case Verb::move:
        return t.accept_only({"tool", "verb", "target", "at_mm", "seconds"});
    case Verb::slide:
        return t.accept_only({"tool", "verb", "target", "at_mm", "seconds"});
    case Verb::touch:
    case Verb::press:
        return t.accept_only({"tool", "verb", "target", "force_n", "seconds"});
    case Verb::hold:
        return t.accept_only({"tool", "verb", "force_n", "seconds"});
    case Verb::retract:
    case Verb::grasp:
    case Verb::release:
        return t.accept_only({"tool", "verb", "seconds"});
    case Verb::wait:
        return t.accept_only({"verb", "seconds"});
    case Verb::look:
        return t.accept_only({"verb", "target", "at_mm", "distance_mm", "seconds", "horizon_deg"});
    }
}

ScriptStep parse_step(const TomlTable& t) {
    ScriptStep step;
    step.where = t.where();
    step.verb = static_cast<Verb>(t.choice("verb", {"move", "touch", "press", "hold", "retract",
                                                    "wait", "grasp", "release", "slide", "look"}));
    accept_for(step.verb, t);
    if (step.verb != Verb::wait && step.verb != Verb::look)
        step.tool = static_cast<Role>(t.choice("tool", {"left", "right", "assist"}));
    if (t.has("target") || step.verb == Verb::touch)
        step.target = t.text("target");
    const bool goes =
        step.verb == Verb::move || step.verb == Verb::slide || step.verb == Verb::look;
    if (t.has("at_mm") || (goes && step.target.empty()))
        step.at_m = t.place_mm("at_mm", kPlace_mm);
    if (step.at_m && !step.target.empty())
        t.refuse("at_mm", "either at_mm or target, not both");
    if (t.has("force_n") || step.verb == Verb::press)
        step.force_n = t.number("force_n", kForce_n);
    if (t.has("seconds") || step.verb == Verb::hold || step.verb == Verb::wait ||
        step.verb == Verb::slide)
        step.seconds = t.number("seconds", kSeconds);
    if (step.verb == Verb::look) {
        constexpr double kRadPerDeg = std::numbers::pi / 180.0;
        step.distance_m = 1e-3 * t.number("distance_mm", {10.0, 500.0});
        step.horizon_rad = kRadPerDeg * t.number("horizon_deg", {-180.0, 180.0}, 0.0);
    }
    return step;
}

Expectation parse_expectation(const TomlTable& t) {
    t.accept_only({"metric", "min", "max"});
    Expectation expected;
    expected.metric = t.text("metric");
    if (t.has("min") || !t.has("max"))
        expected.min = t.number("min", kAny);
    if (t.has("max"))
        expected.max = t.number("max", kAny);
    if (expected.min && expected.max && *expected.min > *expected.max)
        t.refuse("max", "a number not below min");
    return expected;
}

} // namespace

Script parse_script(std::string_view text, std::string_view file) {
    const TomlTable root = TomlTable::parse(text, file);
    root.accept_only({"step", "expect"});
    Script script;
    for (const TomlTable& t : root.tables("step"))
        script.step.push_back(parse_step(t));
    if (script.step.empty())
        root.refuse("step", "at least one table written as [[step]]");
    for (const TomlTable& t : root.tables("expect"))
        script.expect.push_back(parse_expectation(t));
    return script;
}

ExpectationResult check(const Expectation& expected, std::span<const Metric> metrics) {
    std::ostringstream name, message;
    if (expected.min)
        name << *expected.min << " <= ";
    name << expected.metric;
    if (expected.max)
        name << " <= " << *expected.max;
    const auto found = std::find_if(metrics.begin(), metrics.end(), [&](const Metric& metric) {
        return metric.id == expected.metric;
    });
    ExpectationResult result;
    result.name = name.str();
    if (found == metrics.end()) {
        message << "no such metric in this attempt; there are:";
        for (const Metric& metric : metrics)
            message << ' ' << metric.id;
    } else {
        result.ok = (!expected.min || found->value >= *expected.min) &&
                    (!expected.max || found->value <= *expected.max);
        message << expected.metric << " was " << found->value << ' ' << found->unit;
    }
    result.message = message.str();
    return result;
}

} // namespace tasks
