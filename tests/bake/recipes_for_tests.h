// tests/bake/recipes_for_tests.h
// The shipped recipes as text, shared by the tests of bake.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace bake_tests {

inline std::string slurp(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

inline std::string organ_text(const std::string& name) {
    return slurp(std::filesystem::path(ORGAN_RECIPES) / (name + ".toml"));
}

} // namespace bake_tests
