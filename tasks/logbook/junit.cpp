// tasks/logbook/junit.cpp
// JUnit XML from a list of results; see junit.h.
#include "tasks/logbook/junit.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tasks {
namespace {

struct CodePoint {
    std::uint32_t value = 0;
    std::size_t bytes = 0; // 0: not UTF-8
};

// The first code point of a text that is not empty (RFC 3629: shortest form, no surrogates).
CodePoint decoded(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = byte(0);
    if (lead < 0x80)
        return {lead, 1};
    const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes)
        return {};
    std::uint32_t value = lead & (0x7fU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80)
            return {};
        value = (value << 6) | (byte(i) & 0x3fU);
    }
    constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = value >= 0xd800 && value <= 0xdfff;
    if (value < kSmallest[bytes] || surrogate || value > 0x10ffff)
        return {};
    return {value, bytes};
}

// The Char production of XML 1.0, section 2.2; surrogates never come here.
bool is_xml_char(std::uint32_t value) {
    return value == '\t' || value == '\n' || value == '\r' ||
           (value >= 0x20 && value != 0xfffe && value != 0xffff);
}

// For a quoted attribute. Tab and line ends are written as references, or a reader would turn
// them into spaces (XML 1.0, section 3.3.3).
std::string escaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const CodePoint point = decoded(text);
        const std::size_t bytes = std::max<std::size_t>(point.bytes, 1);
        if (point.bytes == 0 || !is_xml_char(point.value))
            out += "\xef\xbf\xbd"; // U+FFFD
        else if (point.value == '&' || point.value == '<' || point.value == '>' ||
                 point.value == '"' || point.value == '\'' || point.value < 0x20)
            out += fmt::format("&#{};", point.value);
        else
            out += text.substr(0, bytes);
        text.remove_prefix(bytes);
    }
    return out;
}

double finite_seconds(double seconds) {
    return std::isfinite(seconds) && seconds > 0.0 ? seconds : 0.0;
}

} // namespace

std::string junit_xml(std::string_view suite, std::span<const ExpectationResult> results) {
    double total_s = 0.0;
    for (const ExpectationResult& result : results)
        total_s += finite_seconds(result.seconds);
    const auto failures =
        std::count_if(results.begin(), results.end(), [](const auto& r) { return !r.ok; });

    const std::string name = escaped(suite);
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    xml += fmt::format("<testsuites>\n  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" "
                       "errors=\"0\" skipped=\"0\" time=\"{:.3f}\">\n",
                       name, results.size(), failures, total_s);
    for (const ExpectationResult& result : results) {
        xml += fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", name,
                           escaped(result.name), finite_seconds(result.seconds));
        if (result.ok)
            xml += "/>\n";
        else
            xml += fmt::format(">\n      <failure message=\"{}\"/>\n    </testcase>\n",
                               escaped(result.message));
    }
    return xml + "  </testsuite>\n</testsuites>\n";
}

} // namespace tasks
