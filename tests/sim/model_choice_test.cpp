// tests/sim/model_choice_test.cpp
#include "sim/session/model_choice.h"

#include <array>
#include <doctest/doctest.h>
#include <stdexcept>

namespace {

using sim::ModelChoice;
using tissue::Tier;

const std::array<std::string, 3> kOrgan{"flap", "artery", "wall"};

} // namespace

TEST_CASE("model choice: one word is for every organ, and organs may be named apart") {
    CHECK(sim::parse_model("quadratic", kOrgan) == ModelChoice(3, Tier::quadratic));
    CHECK(sim::parse_model("linear-compliance,artery=rigid,flap=quadratic", kOrgan) ==
          ModelChoice{Tier::quadratic, Tier::rigid, Tier::linear});
    CHECK(sim::parse_model("artery=rigid", kOrgan) ==
          ModelChoice{sim::kUsualTier, Tier::rigid, sim::kUsualTier});
}

TEST_CASE("model choice: what is written is what was chosen, as far as it deforms") {
    const std::vector<bool> soft{true, true, false};
    for (const Tier flap : {Tier::rigid, Tier::linear, Tier::corotated, Tier::quadratic}) {
        for (const Tier artery : {Tier::rigid, Tier::linear, Tier::corotated, Tier::quadratic}) {
            const ModelChoice choice{flap, artery, Tier::rigid};
            const ModelChoice back =
                sim::parse_model(sim::model_text(choice, kOrgan, soft), kOrgan);
            CHECK(back[0] == flap);
            CHECK(back[1] == artery);
        }
    }
    CHECK(sim::model_text({Tier::corotated, Tier::corotated, Tier::rigid}, kOrgan, soft) ==
          "corotated");
    CHECK(sim::model_text({Tier::rigid, Tier::rigid, Tier::rigid}, kOrgan, {false, false, false}) ==
          "corotated");
}

TEST_CASE("model choice: a wrong word is named, with all that would be accepted") {
    const auto message = [](const std::string& text) {
        try {
            sim::parse_model(text, kOrgan);
        } catch (const std::invalid_argument& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    const auto says = [&](const std::string& text, const std::string& what) {
        INFO(text);
        const std::string said = message(text);
        CHECK(said.starts_with("model \"" + text + "\": " + what + "; accepted: "));
        for (const std::string_view accepted : tissue::kTierNames)
            CHECK(said.find(accepted, said.find("accepted")) != std::string::npos);
        CHECK(said.find("auto") != std::string::npos);
        CHECK(said.find("ORGAN=MODEL[,ORGAN=MODEL..]") != std::string::npos);
    };
    says("plastic", "\"plastic\" is no model");
    says("", "\"\" is no model");
    says("corotated,liver=rigid", "no organ \"liver\", the scene has flap, artery, wall");
    says("corotated,rigid", "\"rigid\" after a comma names no organ");
    says("corotated,flap=", "\"\" is no model");
    says("corotated,flap=auto", "\"auto\" is no model");
}
