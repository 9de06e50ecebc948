// tests/tasks/junit_test.cpp
// JUnit XML: counts, escapes, and texts that were never meant for XML.
#include "tasks/logbook/junit.h"

#include <doctest/doctest.h>
#include <limits>
#include <rapidcheck.h>

namespace {

std::string name_attribute(const std::string& name) {
    const std::vector<tasks::ExpectationResult> one{{.name = name, .ok = true, .message = ""}};
    const std::string xml = tasks::junit_xml("s", one);
    const std::string before = "classname=\"s\" name=\"";
    const auto begin = xml.find(before) + before.size();
    return xml.substr(begin, xml.find('"', begin) - begin);
}

} // namespace

TEST_CASE("a suite lists passes and failures with their counts and times") {
    const std::vector<tasks::ExpectationResult> results{
        {.name = "time", .ok = true, .message = "unused", .seconds = 1.25},
        {.name = "path_length", .ok = false, .message = "0.9 m > 0.8 m", .seconds = 0.5}};
    CHECK(tasks::junit_xml("touch-points", results) ==
          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<testsuites>\n"
          "  <testsuite name=\"touch-points\" tests=\"2\" failures=\"1\" errors=\"0\" "
          "skipped=\"0\" time=\"1.750\">\n"
          "    <testcase classname=\"touch-points\" name=\"time\" time=\"1.250\"/>\n"
          "    <testcase classname=\"touch-points\" name=\"path_length\" time=\"0.500\">\n"
          "      <failure message=\"0.9 m &#62; 0.8 m\"/>\n"
          "    </testcase>\n"
          "  </testsuite>\n"
          "</testsuites>\n");
}

TEST_CASE("a hostile name cannot leave its attribute") {
    CHECK(name_attribute("\"/><failure message='x'/>&amp;\r\n\t") ==
          "&#34;/&#62;&#60;failure message=&#39;x&#39;/&#62;&#38;amp;&#13;&#10;&#9;");
}

TEST_CASE("what XML cannot hold becomes the replacement character, the rest stays") {
    const std::string replaced = "\xef\xbf\xbd";
    CHECK(name_attribute(std::string("a\0b\x1b", 4)) == "a" + replaced + "b" + replaced);
    CHECK(name_attribute("\xc3\xbc \xe2\x82\xac \xf0\x9f\x98\x80") ==
          "\xc3\xbc \xe2\x82\xac \xf0\x9f\x98\x80");
    CHECK(name_attribute("\xc3") == replaced);                               // cut short
    CHECK(name_attribute("\xc0\xaf") == replaced + replaced);                // overlong
    CHECK(name_attribute("\xed\xa0\x80") == replaced + replaced + replaced); // surrogate
    CHECK(name_attribute("\xef\xbf\xbe") == replaced);                       // U+FFFE
    CHECK(name_attribute("\xf4\x90\x80\x80") == replaced + replaced + replaced + replaced);
}

TEST_CASE("no text of any bytes adds a tag or a raw control character") {
    CHECK(rc::check("any bytes", [] {
        const auto text = *rc::gen::arbitrary<std::string>();
        const std::vector<tasks::ExpectationResult> one{
            {.name = text, .ok = false, .message = text}};
        const std::string xml = tasks::junit_xml(text, one);
        // Eight tags, the declaration and twelve attributes; nothing else.
        RC_ASSERT(std::count(xml.begin(), xml.end(), '<') == 8);
        RC_ASSERT(std::count(xml.begin(), xml.end(), '>') == 8);
        RC_ASSERT(std::count(xml.begin(), xml.end(), '"') == 24);
        for (const char c : xml)
            RC_ASSERT(static_cast<unsigned char>(c) >= 0x20 || c == '\n');
    }));
}

TEST_CASE("a time that is no time is written as zero") {
    const std::vector<tasks::ExpectationResult> results{
        {.name = "a",
         .ok = true,
         .message = "",
         .seconds = std::numeric_limits<double>::quiet_NaN()},
        {.name = "b", .ok = true, .message = "", .seconds = -1.0}};
    const std::string xml = tasks::junit_xml("s", results);
    CHECK(xml.find("nan") == std::string::npos);
    CHECK(xml.find("time=\"-") == std::string::npos);
    CHECK(tasks::junit_xml("s", {}).find("tests=\"0\"") != std::string::npos);
}
