// sim/study/failures_study.h
// trocar study failures: scenes in which methods of contact and of tissue are known to fail, each
// method in each scene, measured against theory. A naive method has to fail where and as described,
// ours must not. Called by the command and by the tests.
#pragma once

#include "haptics/contact/god_object.h"
#include "haptics/contact/penalty.h"
#include "haptics/contact/safe_proxy.h"
#include "haptics/contact/virtual_proxy.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sim {

/// A contact method for a ball on a mesh: see haptics/contact/proxy_method.h.
struct ContactMethod {
    std::string_view name;
    void (*step)(const haptics::CollisionIndex&, const haptics::MeshView&,
                 const haptics::ProxyInput&, haptics::ProxyState&) noexcept;
    bool ball = true; // false: it knows a point only, scenes give it radius 0
};

/// To add a method, add a line: no scene expects anything wrong of a name that it does not know.
inline constexpr std::array kContactMethods{
    ContactMethod{"penalty", haptics::step_penalty, false},
    ContactMethod{"god-object", haptics::step_god_object, false},
    ContactMethod{"virtual-proxy", haptics::step_virtual_proxy},
    ContactMethod{"ours", haptics::step_safe_proxy},
};

struct FailureRow {
    std::string scene, method, quantity; // the quantity with its unit
    double measured = 0.0;
    double bound = 0.0; // at most this is right; `near`: the theory's value
    bool near = false;  // within `tolerance` of the bound, relative
    double tolerance = 0.0;
    bool wrong_expected = false; // the method is known to fail here: right would be a surprise
    bool passed = false;         // it behaved as expected
    double margin = 0.0; // by how much, of the bound (if that is 0, in the unit); below 0: not
};

struct FailureOptions {
    std::uint64_t seed = 1;
    std::vector<std::string> scenes; // "F1" ..; empty: all
};

/// All scenes of this list, in its order. Throws std::invalid_argument for a scene that is not
/// there. Deterministic for a seed.
std::vector<FailureRow> run_failures_study(const FailureOptions& options);

/// failures.csv, failures.md and the picture failures.svg. Throws if they cannot be written.
void write_failures_study(const FailureOptions& options, const std::vector<FailureRow>& rows,
                          const std::filesystem::path& out);

/// The same as text for a terminal.
std::string failures_table(const std::vector<FailureRow>& rows);

} // namespace sim
