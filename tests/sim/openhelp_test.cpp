// tests/sim/openhelp_test.cpp
// Real anatomy from surface file to replayed attempt, by the commands that anybody would use: the
// upper abdomen of tests/data/openhelp. Needs surfaces that do not come with this project; skipped
// by name where they are missing. The real-time figures are for a machine with nothing else to do:
// label slow.
#include "tests/sim/command_fixture.h"

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <unistd.h>

using namespace command_tests;

namespace fs = std::filesystem;

namespace {

const fs::path kSurfaces = fs::path(TROCAR_SOURCE) / "../shared/data/openhelp";
const fs::path kScene = fs::path(TROCAR_SOURCE) / "tests/data/openhelp";

/// The scene with its organs, made once for all cases.
class Abdomen {
  public:
    Abdomen()
        : folder_(fs::temp_directory_path() / ("trocar_openhelp_" + std::to_string(getpid()))) {
        fs::copy(kScene, folder_, fs::copy_options::recursive);
        add("liver", "--material liver");
        add("stomach", "--material stomach");
        add("spleen", "--material spleen");
        add("abdominal_wall", "--rigid");
    }
    ~Abdomen() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    Abdomen(const Abdomen&) = delete;
    Abdomen& operator=(const Abdomen&) = delete;

    std::string path() const { return folder_.string(); }
    std::string file(const std::string& name) const { return (folder_ / name).string(); }

  private:
    void add(const std::string& name, const std::string& as) {
        const fs::path out = folder_ / "imported" / name;
        fs::create_directories(out.parent_path());
        const Answer answer = trocar("import '" + (kSurfaces / (name + ".stl")).string() +
                                     "' --unit mm " + as + " --out '" + out.string() + "'");
        CAPTURE(answer.text);
        REQUIRE(answer.exit_code == 0);
        fs::rename(out / (name + ".organ"), folder_ / (name + ".organ"));
    }

    fs::path folder_;
};

const Abdomen& abdomen() {
    static const Abdomen made;
    return made;
}

bool missing() {
    if (fs::is_directory(kSurfaces))
        return false;
    MESSAGE("skipped: ../shared/data/openhelp is not there");
    return true;
}

} // namespace

TEST_CASE("openhelp: the imported abdomen is a usable scene") {
    if (missing())
        return;
    const Answer check = trocar("scene check '" + abdomen().path() + "'");
    CAPTURE(check.text);
    CHECK(check.exit_code == 0);
}

TEST_CASE("openhelp: an expert touches all points on the liver, and the attempt replays") {
    if (missing())
        return;
    const std::string log = abdomen().file("log.db");
    const auto ran = json_of("run touch-points --scene '" + abdomen().path() +
                             "' --seed 11 --json --log '" + log + "'");
    CHECK(ran["completed"] == true);
    CHECK(ran["valid"] == true);
    CHECK(ran["metrics"]["errors"] == 0);
    const auto again = json_of("replay '" + log + "' 1 --scene '" + abdomen().path() + "' --json");
    CHECK(again["log_sha256"] == ran["log_sha256"]);
}

TEST_CASE("openhelp: three tools press on the liver in real time, and the attempt replays" *
          doctest::test_suite("slow")) {
    if (missing())
        return;
    const std::string log = abdomen().file("realtime.db");
    const auto ran =
        json_of("run touch-points --scene '" + abdomen().path() + "' --realtime --seconds 30 " +
                "--hands '" + abdomen().file("press-three.toml") + "' --json --log '" + log + "'");
    CHECK(ran["valid"] == true);
    CHECK(ran["rig"]["fem_ms"]["p99"].get<double>() <= 10.0);
    CHECK(ran["rig"]["tick_us"]["p9999"].get<double>() <= 500.0);
    const auto again = json_of("replay '" + log + "' 1 --scene '" + abdomen().path() + "' --json");
    CHECK(again["log_sha256"] == ran["log_sha256"]);
}
