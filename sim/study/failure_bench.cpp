#include "sim/study/failure_bench.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace sim::failure {

void Rows::at_most(std::string scene, std::string_view method, std::string quantity,
                   double measured, double bound, bool wrong_expected) {
    const bool right = measured <= bound; // also false for what is not finite
    const double over = bound > 0.0 ? measured / bound - 1.0 : measured;
    row.push_back({.scene = std::move(scene),
                   .method = std::string(method),
                   .quantity = std::move(quantity),
                   .measured = measured,
                   .bound = bound,
                   .wrong_expected = wrong_expected,
                   .passed = right != wrong_expected && std::isfinite(measured),
                   .margin = wrong_expected ? over : 0.0 - over});
}

void Rows::near(std::string scene, std::string_view method, std::string quantity, double measured,
                double value, double tolerance, bool wrong_expected) {
    const double off = std::abs(measured / value - 1.0);
    row.push_back({.scene = std::move(scene),
                   .method = std::string(method),
                   .quantity = std::move(quantity),
                   .measured = measured,
                   .bound = value,
                   .near = true,
                   .tolerance = tolerance,
                   .wrong_expected = wrong_expected,
                   .passed = off <= tolerance,
                   .margin = tolerance - off});
}

void Scene::quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const auto v = static_cast<std::uint32_t>(vertex.size());
    vertex.insert(vertex.end(), {a, b, c, d});
    triangle.insert(triangle.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
}

void Scene::box(const dvec3& l, const dvec3& h) {
    quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z});
    quad({l.x, h.y, l.z}, {h.x, h.y, l.z}, {h.x, l.y, l.z}, {l.x, l.y, l.z});
    quad({h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}, {h.x, l.y, h.z});
    quad({l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z}, {l.x, l.y, l.z});
    quad({l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z});
    quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z});
}

void Scene::ready() {
    index = haptics::make_index("brute-force", {vertex, triangle, {}});
}

void Scene::move_to(const std::vector<dvec3>& vertices) {
    before = vertex;
    vertex = vertices;
    haptics::refit(index, {vertex, triangle, before});
}

const haptics::ProxyState& Scene::tick(const ContactMethod& method, const dvec3& device_m) {
    input.device_m = device_m;
    method.step(index, {vertex, triangle, before}, input, state);
    if (!before.empty()) { // it rests until it is moved again
        before.clear();
        haptics::refit(index, {vertex, triangle, {}});
    }
    return state;
}

void FreeAxis::step(double force_n) {
    const double decay = std::exp(-damping_nspm * kTick_s / mass_kg);
    const double terminal_mps = force_n / damping_nspm;
    place_m += terminal_mps * kTick_s +
               (speed_mps - terminal_mps) * (1.0 - decay) * mass_kg / damping_nspm;
    speed_mps = terminal_mps + (speed_mps - terminal_mps) * decay;
}

double bisect(double holds_at, double fails_at, const std::function<bool(double)>& holds) {
    while (std::abs(fails_at - holds_at) > 1e-3 * std::abs(holds_at)) {
        const double middle = 0.5 * (holds_at + fails_at);
        (holds(middle) ? holds_at : fails_at) = middle;
    }
    return 0.5 * (holds_at + fails_at);
}

} // namespace sim::failure
