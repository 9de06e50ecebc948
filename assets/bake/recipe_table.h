// assets/bake/recipe_table.h
// One TOML table with errors that say file, line, key, value and what would be accepted. Called
// by recipe.cpp only; keys that were never asked for are errors too.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bake {

class Table {
  public:
    static Table parse(const std::string& text, const std::string& file_name);

    [[nodiscard]] bool has(const char* key) const;
    // without `usual` the key must be there
    [[nodiscard]] double number(const char* key, double low, double high,
                                std::optional<double> usual = {}) const;
    [[nodiscard]] long long integer(const char* key, long long low, long long high,
                                    long long usual) const;
    [[nodiscard]] glm::dvec3 vector(const char* key, double low, double high,
                                    std::optional<glm::dvec3> usual = {}) const;
    [[nodiscard]] glm::dvec2 pair(const char* key, double low, double high) const;
    // of at least `fewest`
    [[nodiscard]] std::vector<glm::dvec3> vectors(const char* key, std::size_t fewest, double low,
                                                  double high) const;
    [[nodiscard]] std::string text(const char* key) const;
    [[nodiscard]] std::string word(const char* key, std::initializer_list<const char*> accepted,
                                   std::optional<std::string> usual = {}) const;
    [[nodiscard]] Table table(const char* key) const;
    [[nodiscard]] std::vector<Table> tables(const char* key) const; // none if absent

    [[nodiscard]] std::vector<std::string> keys() const; // sorted

    /// Throws RecipeError if the table has a key that none of the above was called with.
    void no_other_keys() const;
    [[noreturn]] void refuse(const char* key, const std::string& accepted) const;
    [[noreturn]] void missing(const char* key, const std::string& accepted) const;

  private:
    struct State;
    explicit Table(std::shared_ptr<State> state) : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

} // namespace bake
