// tests/sim/trajectory_file_test.cpp
// A trajectory is read as its columns say, and what is wrong with it is said with file, line and
// value.
#include "sim/io/trajectory_file.h"

#include <doctest/doctest.h>
#include <stdexcept>

namespace {

std::vector<sim::TrajectorySample> read(std::string_view text) {
    return sim::read_trajectory(std::as_bytes(std::span(text)), "path.csv");
}

void refused(std::string_view text, const char* says) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(read(text), doctest::Contains(says), std::runtime_error);
}

} // namespace

TEST_CASE("trajectory: columns go by name, other columns and empty lines mean nothing") {
    const auto path = read("\xef\xbb\xbfz , name,\"t\",x,y\r\n"
                           "3,\"a, b\",0.5,1,2\r\n"
                           "\n"
                           " -3e-2 ,,0.75, +1.5,\"2\"\n");
    REQUIRE(path.size() == 2);
    CHECK(path[0].time_s == 0.5);
    CHECK(path[0].place_m == glm::dvec3{1.0, 2.0, 3.0});
    CHECK(path[1].time_s == 0.75);
    CHECK(path[1].place_m == glm::dvec3{1.5, 2.0, -0.03});
    CHECK(read("t,x,y,z\n1,2,3,4").size() == 1); // no line end at the end
}

TEST_CASE("trajectory: what is wrong is said with file, line and value") {
    refused("", "path.csv: has no rows");
    refused("t,x,y,z\n", "path.csv: has no rows");
    refused("t,x,y\n0,1,2\n", "path.csv: line 1: column \"z\" is missing");
    refused("t,x,y,z,x\n", "line 1: column \"x\" is there twice");
    refused("0,1,2,3\n", "line 1: column \"t\" is missing");
    refused("t,x,y,z\n0,1,2,3\n1,1,2\n", "path.csv: line 3: z is missing");
    refused("t,x,y,z\n0,1,,3\n", "line 2: y is \"\": accepted: a finite number");
    refused("t,x,y,z\n\n0,1,2m,3\n", "line 3: y is \"2m\"");
    refused("t,x,y,z\n0,nan,2,3\n", "line 2: x is \"nan\"");
    refused("t,x,y,z\n0,1,2,inf\n", "line 2: z is \"inf\"");
    refused("t,x,y,z\n0,1,2,1e999\n", "line 2: z is \"1e999\"");
    refused("t,x,y,z\n0,+-1,2,3\n", "line 2: x is \"+-1\"");
    refused("t,x,y,z\n0,\"1,2,3\n", "line 2: a quotation mark does not close");
    refused("t,x,y,z\n1,0,0,0\n0.5,0,0,0\n", "path.csv: line 3: t is 0.5, after 1");
    refused("t,x,y,z\n1,0,0,0\n1,0,0,0\n", "line 3: t is 1, after 1");
    refused(std::string_view("t,x,y,z\n0,\x01\0,2,3\n", 17), "line 2: x is \"??\"");
}

TEST_CASE("trajectory: ticks lie on the straight lines between samples, both ends included") {
    const auto path = sim::at_ticks(read("t,x,y,z\n10,0,0,0\n10.002,2,0,4\n10.003,2,1,4\n"));
    REQUIRE(path.size() == 4);
    CHECK(glm::dvec3{0.0, 0.0, 0.0} == path[0]);
    CHECK(path[1].x == doctest::Approx(1.0).scale(0.0).epsilon(1e-9));
    CHECK(path[1].z == doctest::Approx(2.0).scale(0.0).epsilon(1e-9));
    CHECK(path[2].y == doctest::Approx(0.0).scale(1.0).epsilon(1e-9));
    CHECK(path[3] == glm::dvec3{2.0, 1.0, 4.0});
    CHECK(sim::at_ticks(read("t,x,y,z\n7,1,2,3\n")).size() == 1);
    CHECK_THROWS_AS(sim::at_ticks(read("t,x,y,z\n0,0,0,0\n1e300,0,0,0\n")), std::invalid_argument);
}
