// tasks/logbook/junit.h
// Expectations of a scripted run as JUnit XML, for build servers. Text only: whoever calls it
// writes the file. Not for the 1 kHz thread.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tasks {

struct ExpectationResult {
    std::string name; // "path_length <= 0.8 m"
    bool ok = false;
    std::string message; // what was seen; shown when not ok
    double seconds = 0.0;
};

/// One <testsuite>. Any bytes may stand in the texts: what XML 1.0 cannot hold (control characters,
/// broken UTF-8, lone surrogates) becomes U+FFFD. Numbers have a point in every locale; a time that
/// is not finite or negative is written as 0.
std::string junit_xml(std::string_view suite, std::span<const ExpectationResult> results);

} // namespace tasks
