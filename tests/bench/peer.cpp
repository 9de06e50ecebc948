#include "tests/bench/peer.h"

#include "sim/study/tick_times_json.h"

#include <cstdlib>
#include <exception>
#include <fmt/format.h>
#include <stdexcept>

namespace bench {
namespace {

using glm::dvec3;
using nlohmann::ordered_json;

constexpr int kRefitsAtRest = 9;

[[noreturn]] void usage(const std::string& what) {
    throw std::invalid_argument(what + "\nusage: organ:COUNT|sheet:COUNT [--seconds S] [--seed N] "
                                       "[--radius MM] [--reach MM] [--breathe MM] "
                                       "[--wave radial|travelling] [--cold] [--cold-every N]");
}

double number(const std::string& option, const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !(value >= 0.0 && value <= 1e9))
        usage(option + " '" + text + "' is not a number from 0");
    return value;
}

struct Times {
    std::vector<double> contact_ns, free_ns, refit_ns;
    double distance_sum_m = 0.0;
    int missed = 0;    // contact ticks in which the peer found no skin
    int preempted = 0; // ticks left out of the times
};

/// The path once; `evict` before every `every`th contact tick, and only those are kept. Which ticks
/// are contact ticks is known from `is_contact`, or, if that is empty, learnt into it.
Times run_path(const Peer& peer, const PeerOptions& o, const sim::ContactWorkload& work,
               const sim::TickClock& clock, std::vector<char>& is_contact,
               sim::CacheEvictor* cold) {
    const auto path = sim::contact_path(work, o.seconds, o.seed, o.radius_m);
    const bool learn = is_contact.empty();
    is_contact.resize(path.size());
    Times out;
    sim::MovingSkin skin;
    sim::PreemptionWatch watch;
    int contacts = 0;
    for (std::size_t tick = 0; tick < path.size(); ++tick) {
        follow(work, o.breathing, static_cast<int>(tick), skin);
        if (skin.moved || tick == 0) {
            peer.take(skin.view(work));
            const std::uint64_t from = clock.start();
            peer.refit();
            if (skin.moved)
                out.refit_ns.push_back(clock.ns(from, clock.stop()));
        }
        const bool keep = cold == nullptr || (is_contact[tick] && contacts % o.cold_every == 0);
        if (cold != nullptr && keep)
            cold->evict();
        const std::uint64_t from = clock.start();
        const PeerAnswer answer = peer.ask(path[tick]);
        const double ns = clock.ns(from, clock.stop());
        const bool preempted = watch.preempted(ns);
        out.preempted += preempted;
        if (learn)
            is_contact[tick] = side_of(work, skin.now_m, path[tick]) != 1 ||
                               (answer.hit && answer.distance_m <= o.radius_m);
        contacts += is_contact[tick];
        if (is_contact[tick]) {
            out.distance_sum_m += answer.hit ? answer.distance_m : 0.0;
            out.missed += !answer.hit;
        }
        if (keep && !preempted)
            (is_contact[tick] ? out.contact_ns : out.free_ns).push_back(ns);
    }
    return out;
}

} // namespace

PeerOptions peer_options(int argc, char** argv) {
    PeerOptions o;
    const std::vector<std::string> word(argv + 1, argv + argc);
    for (std::size_t i = 0; i < word.size(); ++i) {
        const auto value = [&] {
            if (i + 1 == word.size())
                usage(word[i] + " lacks its value");
            return word[++i];
        };
        const std::string option = word[i];
        if (option == "--seconds")
            o.seconds = number(option, value());
        else if (option == "--seed")
            o.seed = static_cast<std::uint64_t>(number(option, value()));
        else if (option == "--radius")
            o.radius_m = 1e-3 * number(option, value());
        else if (option == "--reach")
            o.reach_m = 1e-3 * number(option, value());
        else if (option == "--breathe")
            o.breathing.amplitude_m = 1e-3 * number(option, value());
        else if (option == "--wave")
            o.breathing.wave = sim::wave_of(value());
        else if (option == "--cold")
            o.cold = true;
        else if (option == "--cold-every")
            o.cold_every = std::max(1, static_cast<int>(number(option, value())));
        else if (o.mesh.empty() && !option.starts_with("-"))
            o.mesh = option;
        else
            usage("'" + option + "' is not known");
    }
    if (o.mesh.empty())
        usage("no mesh");
    return o;
}

ordered_json run_peer(const PeerOptions& o, const sim::ContactWorkload& work,
                      const std::function<Peer(const haptics::MeshView&)>& make) {
    const sim::TickClock clock;
    sim::MovingSkin skin;
    follow(work, o.breathing, 0, skin);
    const std::uint64_t from = clock.start();
    const Peer peer = make(skin.view(work));
    const double build_ms = 1e-6 * clock.ns(from, clock.stop());
    std::vector<double> refit_ns; // at rest; in motion the frames count
    for (int i = 0; i < kRefitsAtRest; ++i) {
        peer.take(skin.view(work));
        const std::uint64_t began = clock.start();
        peer.refit();
        refit_ns.push_back(clock.ns(began, clock.stop()));
    }
    std::vector<char> is_contact;
    const Times hot = run_path(peer, o, work, clock, is_contact, nullptr);
    Times cold;
    sim::CacheEvictor evictor;
    if (o.cold)
        cold = run_path(peer, o, work, clock, is_contact, &evictor);
    return {{"method", peer.name},
            {"contact_method", "none"},
            {"triangles", work.triangle.size()},
            {"contact", tick_times_json(sim::tick_times(hot.contact_ns))},
            {"free", tick_times_json(sim::tick_times(hot.free_ns))},
            {"cold", tick_times_json(sim::tick_times(cold.contact_ns))},
            {"build_ms", build_ms},
            {"refit_ms", 1e-6 * (hot.refit_ns.empty() ? sim::tick_times(refit_ns).p50_ns
                                                      : sim::tick_times(hot.refit_ns).mean_ns)},
            {"distance_sum_m", peer.closest ? hot.distance_sum_m : 0.0},
            {"missed", hot.missed},
            {"preempted", hot.preempted},
            {"reach_m", o.reach_m},
            {"clock_overhead_ns", clock.overhead_ns()}};
}

int peer_main(
    int argc, char** argv,
    const std::function<ordered_json(const PeerOptions&, const sim::ContactWorkload&)>& json) {
    try {
        const PeerOptions o = peer_options(argc, argv);
        const sim::ContactWorkload work = sim::make_contact_workload(o.mesh, o.seed);
        fmt::print("{}\n", json(o, work).dump());
    } catch (const std::exception& e) {
        fmt::print(stderr, "{}: {}\n", argv[0], e.what());
        return 2;
    }
    return 0;
}

} // namespace bench
