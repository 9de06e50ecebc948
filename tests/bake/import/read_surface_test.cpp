#include "assets/bake/import/read_surface.h"

#include "tests/bake/import/surface_files.h"
#include "tests/bake/shapes_for_tests.h"

#include <doctest/doctest.h>
#include <random>

using namespace bake_tests;

namespace {

double area_of(const bake::Soup& soup) {
    return bake::area_m2({soup.point, soup.triangles});
}

void refuses(const std::string& text, const std::string& name, const char* message) {
    CAPTURE(text.substr(0, 200));
    CHECK_THROWS_WITH_AS(bake::read_surface(bytes_of(text), name), doctest::Contains(message),
                         bake::ReadError);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

} // namespace

TEST_CASE("readers: the same body comes out of every format") {
    const auto s = globe(30.0, 12, 8);
    const std::pair<std::string, std::string> files[] = {{"a.stl", binary_stl(s)},
                                                         {"b.STL", ascii_stl(s)},
                                                         {"c.obj", obj(s)},
                                                         {"d.off", off(s)},
                                                         {"e.ply", ply(s, "ascii")},
                                                         {"f.ply", ply(s, "binary_little_endian")},
                                                         {"g.Ply", ply(s, "binary_big_endian")}};
    for (const auto& [name, text] : files) {
        CAPTURE(name);
        const auto soup = bake::read_surface(bytes_of(text), name);
        CHECK(soup.triangles.size() == s.triangles.size());
        CHECK(area_of(soup) == near(bake::area_m2(s), 1e-5)); // text has six digits, STL floats
        CHECK(bake::volume_m3({soup.point, soup.triangles}) == near(bake::volume_m3(s), 1e-5));
    }
}

TEST_CASE("readers: a binary STL whose header begins with solid is binary") {
    auto text = binary_stl(globe(30.0, 12, 8));
    text.replace(0, 5, "solid");
    CHECK(bake::read_stl(bytes_of(text)).format == "binary STL");
}

TEST_CASE("readers: a concave polygon keeps its area") {
    // an L of three unit squares
    const std::string text = "OFF\n6 1 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n"
                             "6 0 1 2 3 4 5\n";
    const auto soup = bake::read_off(bytes_of(text));
    CHECK(soup.triangles.size() == 4);
    CHECK(area_of(soup) == near(3.0));
    CHECK(area_of(bake::read_obj(bytes_of("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                                          "f -6 -5 -4 \\\n -3 -2 -1\n"))) == near(3.0));
}

TEST_CASE("readers: what is wrong is named with its line or byte and what would be accepted") {
    const auto s = globe(30.0, 12, 8);
    refuses("", "a.stl", "byte 0: the file is empty");
    refuses("x", "a.xyz", "accepted: .stl, .obj, .ply, .off");
    refuses("solid", "a.stl", "line 1: the file ends before endsolid");
    refuses("abc", "a.stl", "byte 3: the file ends in its header");
    refuses(binary_stl(s).substr(0, 1000), "a.stl", "byte 80: it counts 168 triangles");
    refuses(replaced(ascii_stl(s), "vertex", "vortex"), "a.stl",
            "line 4: the word here is \"vortex\"");
    refuses(replaced(ascii_stl(s), "vertex 0", "vertex nan"), "a.stl",
            "line 4: a coordinate is \"nan\"");
    refuses(replaced(ascii_stl(s), "vertex 0", "vertex 1e999"), "a.stl",
            "accepted: a finite number");
    refuses(replaced(obj(s), "v 0", "v inf"), "a.obj", "line 3: a coordinate is \"inf\"");
    refuses("v 0 0 0\nf 1 2 3\n", "a.obj", "line 2: a corner is \"2\"");
    refuses("v 0 0 0\nf 0 1 1\n", "a.obj", "accepted: 1 to 1 or -1 to -1");
    refuses("v 1 2\n", "a.obj", "line 1: a vertex with too few numbers");
    refuses("\x7F"
            "ELF\x02\n",
            "a.obj", "line 1: the first word of the line");
    refuses("FOO\n", "a.off", "line 1: the first word is \"FOO\"");
    refuses("OFF\n1000000000 5 0\n", "a.off", "line 2: the number of points is \"1000000000\"");
    refuses(replaced(off(s), "\n3 0 ", "\n3 99 "), "a.off", "a corner is \"99\"");
    refuses("OFF BINARY\n", "a.off", "accepted: OFF as text");
    refuses("plx\n", "a.ply", "line 1: the first word is \"plx\"");
    refuses(ply(s, "ascii").substr(0, 900), "a.ply", "the file ends before");
    refuses(ply(s, "binary_little_endian").substr(0, 900), "a.ply", "byte ");
    refuses(replaced(ply(s, "ascii"), "property double z\n", ""), "a.ply", "lacks a coordinate");
    refuses("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n", "a.ply",
            "line 3: the number of elements");
    refuses("OFF\n0 0 0\n", "a.off", "it has no triangles");
}

TEST_CASE("readers: a coordinate that is not finite is named in binary files too") {
    auto s = globe(30.0, 12, 8);
    s.point_m[0].x = std::nan("");
    refuses(binary_stl(s), "a.stl", "byte 96: coordinate x of corner 1 of triangle 1 is nan");
    refuses(ply(s, "binary_big_endian"), "a.ply", "a coordinate is nan");
}

TEST_CASE("readers: a count in a header buys no memory that the file does not pay for") {
    // two thousand million of everything, in files of a hundred bytes
    std::string stl = binary_stl({});
    stl[83] = '\x7F';
    refuses(stl, "a.stl", "byte 80: it counts");
    refuses("ply\nformat binary_little_endian 1.0\nelement vertex 60\nproperty float x\nproperty "
            "float y\nproperty float z\nend_header\n123456",
            "a.ply", "accepted: no more than the 6 bytes left can hold");
    refuses("OFF 7 99999999\n", "a.off", "line 1: the number of points is");
}

TEST_CASE("readers: ten thousand damaged files each give triangles or a ReadError") {
    const auto s = globe(30.0, 8, 5);
    const std::pair<std::string, std::string> files[] = {{"a.stl", binary_stl(s)},
                                                         {"b.stl", ascii_stl(s)},
                                                         {"c.obj", obj(s)},
                                                         {"d.off", off(s)},
                                                         {"e.ply", ply(s, "ascii")},
                                                         {"f.ply", ply(s, "binary_little_endian")},
                                                         {"g.ply", ply(s, "binary_big_endian")}};
    std::mt19937 random(5);
    int read = 0, refused = 0;
    for (int round = 0; round < 10'000; ++round) {
        auto [name, text] = files[round % 7];
        const int changes = 1 + static_cast<int>(random() % 4);
        for (int i = 0; i < changes; ++i) {
            const std::size_t at = random() % text.size();
            switch (random() % 4) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text.resize(at + 1);
                break;
            case 2:
                text.insert(at, text.substr(random() % text.size(), random() % 20));
                break;
            default:
                text.erase(at, random() % 20);
                text += ' ';
            }
        }
        try {
            const auto soup = bake::read_surface(bytes_of(text), name);
            for (const auto& t : soup.triangles) {
                for (const auto v : t) {
                    REQUIRE(v < soup.point.size());
                }
            }
            ++read;
        } catch (const bake::ReadError&) {
            ++refused;
        }
    }
    CHECK(read > 100);
    CHECK(refused > 100);
}
