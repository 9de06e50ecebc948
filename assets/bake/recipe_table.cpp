#include "assets/bake/recipe_table.h"

#include "assets/bake/recipe.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <span>
#include <sstream>
#include <toml.hpp>

namespace bake {

struct Table::State {
    std::string file_name;
    toml::value value;
    std::set<std::string> asked;
};

namespace {

std::string shown(const toml::value& value) {
    std::ostringstream out;
    out << value;
    std::string text = out.str();
    constexpr std::size_t kLongest = 80;
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

std::string range(const char* what, double low, double high) {
    return fmt::format("{} from {} to {}", what, low, high);
}

bool as_number(const toml::value& value, double low, double high, double& out) {
    if (value.is_integer()) {
        out = static_cast<double>(value.as_integer());
    } else if (value.is_floating()) {
        out = value.as_floating();
    } else {
        return false;
    }
    return out >= low && out <= high; // false for nan
}

bool as_numbers(const toml::value& value, double low, double high, std::span<double> out) {
    if (!value.is_array() || value.as_array().size() != out.size()) {
        return false;
    }
    return std::equal(out.begin(), out.end(), value.as_array().begin(),
                      [&](double& x, const toml::value& v) { return as_number(v, low, high, x); });
}

} // namespace

Table Table::parse(const std::string& text, const std::string& file_name) {
    std::istringstream in(text);
    try {
        auto state = std::make_shared<State>();
        state->file_name = file_name;
        state->value = toml::parse(in, file_name);
        return Table(std::move(state));
    } catch (const std::exception& e) { // toml11 throws several unrelated types
        throw RecipeError(fmt::format("{}: not a TOML file: {}", file_name, e.what()));
    }
}

bool Table::has(const char* key) const {
    state_->asked.insert(key);
    return state_->value.contains(key);
}

void Table::refuse(const char* key, const std::string& accepted) const {
    const toml::value& value = state_->value.at(key);
    throw RecipeError(fmt::format("{}:{}: {} = {}: accepted: {}", state_->file_name,
                                  value.location().line(), key, shown(value), accepted));
}

void Table::missing(const char* key, const std::string& accepted) const {
    throw RecipeError(fmt::format("{}:{}: {} is missing: accepted: {}", state_->file_name,
                                  state_->value.location().line(), key, accepted));
}

double Table::number(const char* key, double low, double high, std::optional<double> usual) const {
    const std::string accepted = range("a number", low, high);
    if (!has(key)) {
        return usual ? *usual : (missing(key, accepted), 0.0);
    }
    double out = 0.0;
    if (!as_number(state_->value.at(key), low, high, out)) {
        refuse(key, accepted);
    }
    return out;
}

long long Table::integer(const char* key, long long low, long long high, long long usual) const {
    if (!has(key)) {
        return usual;
    }
    const toml::value& value = state_->value.at(key);
    if (!value.is_integer() || value.as_integer() < low || value.as_integer() > high) {
        refuse(key, fmt::format("a whole number from {} to {}", low, high));
    }
    return value.as_integer();
}

glm::dvec3 Table::vector(const char* key, double low, double high,
                         std::optional<glm::dvec3> usual) const {
    const std::string accepted = range("[x, y, z], three numbers", low, high);
    if (!has(key)) {
        return usual ? *usual : (missing(key, accepted), glm::dvec3{0.0});
    }
    std::array<double, 3> out{};
    if (!as_numbers(state_->value.at(key), low, high, out)) {
        refuse(key, accepted);
    }
    return {out[0], out[1], out[2]};
}

glm::dvec2 Table::pair(const char* key, double low, double high) const {
    const std::string accepted = range("[x, y], two numbers", low, high);
    if (!has(key)) {
        missing(key, accepted);
    }
    std::array<double, 2> out{};
    if (!as_numbers(state_->value.at(key), low, high, out)) {
        refuse(key, accepted);
    }
    return {out[0], out[1]};
}

std::vector<glm::dvec3> Table::vectors(const char* key, std::size_t fewest, double low,
                                       double high) const {
    const std::string accepted = fmt::format(
        "[[x, y, z], ...], at least {} times three numbers from {} to {}", fewest, low, high);
    if (!has(key)) {
        missing(key, accepted);
    }
    const toml::value& value = state_->value.at(key);
    if (!value.is_array() || value.as_array().size() < fewest) {
        refuse(key, accepted);
    }
    std::vector<glm::dvec3> list;
    for (const toml::value& item : value.as_array()) {
        std::array<double, 3> out{};
        if (!as_numbers(item, low, high, out)) {
            refuse(key, accepted);
        }
        list.emplace_back(out[0], out[1], out[2]);
    }
    return list;
}

std::string Table::text(const char* key) const {
    if (!has(key)) {
        missing(key, "a text");
    }
    const toml::value& value = state_->value.at(key);
    if (!value.is_string() || value.as_string().str.empty()) {
        refuse(key, "a text");
    }
    return value.as_string().str;
}

std::string Table::word(const char* key, std::initializer_list<const char*> accepted,
                        std::optional<std::string> usual) const {
    const std::string list = fmt::format("{}", fmt::join(accepted, ", "));
    if (!has(key)) {
        return usual ? *usual : (missing(key, list), std::string{});
    }
    const toml::value& value = state_->value.at(key);
    if (value.is_string()) {
        for (const char* const word : accepted) {
            if (value.as_string().str == word) {
                return word;
            }
        }
    }
    refuse(key, list);
}

Table Table::table(const char* key) const {
    if (!has(key)) {
        missing(key, fmt::format("a table [{}]", key));
    }
    if (!state_->value.at(key).is_table()) {
        refuse(key, fmt::format("a table [{}]", key));
    }
    return Table(std::make_shared<State>(State{state_->file_name, state_->value.at(key), {}}));
}

std::vector<Table> Table::tables(const char* key) const {
    std::vector<Table> list;
    if (!has(key)) {
        return list;
    }
    const toml::value& value = state_->value.at(key);
    const std::string accepted = fmt::format("tables [[{}]]", key);
    if (!value.is_array()) {
        refuse(key, accepted);
    }
    for (const auto& item : value.as_array()) {
        if (!item.is_table()) {
            refuse(key, accepted);
        }
        list.push_back(Table(std::make_shared<State>(State{state_->file_name, item, {}})));
    }
    return list;
}

std::vector<std::string> Table::keys() const {
    std::set<std::string> names;
    for (const auto& [key, value] : state_->value.as_table()) {
        names.insert(key);
    }
    return {names.begin(), names.end()};
}

void Table::no_other_keys() const {
    std::set<std::string> present; // sorted: the same file always gives the same message
    for (const auto& [key, value] : state_->value.as_table()) {
        present.insert(key);
    }
    for (const auto& key : present) {
        if (!state_->asked.contains(key)) {
            refuse(key.c_str(), fmt::format("one of the keys {}", fmt::join(state_->asked, ", ")));
        }
    }
}

} // namespace bake
