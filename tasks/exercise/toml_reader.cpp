#include "tasks/exercise/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <toml.hpp>

namespace tasks {

struct TomlTable::Node {
    toml::value value;
    std::string file;
    std::size_t line = 1; // of the table's first key or header
};

namespace {

// Deeper nesting than any of our files has; toml11 descends once per bracket.
constexpr int kMaxNesting = 32;

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& what) {
    throw BadInput({file, line, {}, {}}, what);
}

std::string number_text(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

std::string range_text(Range range) {
    return number_text(range.min) + " to " + number_text(range.max);
}

// A value as a person would recognise it in the file, cut to one short line.
std::string shown(const toml::value& value) {
    std::string text;
    try {
        text = toml::format(value, 1u << 20);
    } catch (const std::exception&) {
        text = "?";
    }
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

std::optional<double> as_number(const toml::value& value) {
    if (value.is_integer())
        return static_cast<double>(value.as_integer());
    if (value.is_floating())
        return value.as_floating();
    return {};
}

bool inside(double value, Range range) { // false for NaN
    return value >= range.min && value <= range.max;
}

std::string first_line(const std::string& text) {
    return text.substr(0, std::min(text.find('\n'), std::size_t{160}));
}

// Length of the UTF-8 sequence that `text` begins with; 0: it begins with none. Table 3-7 of the
// Unicode standard: no overlong form, no surrogate, nothing above U+10FFFF.
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = byte(0);
    if (lead < 0x80)
        return 1;
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length)
        return 0;
    const unsigned low = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
    const unsigned high = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
    if (byte(1) < low || byte(1) > high)
        return 0;
    for (std::size_t i = 2; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80)
            return 0;
    }
    return length;
}

// toml11 checks the bytes of basic strings only; in literal ones and comments it takes any.
void require_utf8(std::string_view text, const std::string& file) {
    std::size_t line = 1;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = utf8_length(text.substr(i));
        if (length == 0) {
            std::ostringstream byte;
            byte << "byte 0x" << std::hex << static_cast<int>(static_cast<unsigned char>(text[i]));
            fail(file, line, byte.str() + " is not UTF-8: text in UTF-8 is accepted");
        }
        line += text[i] == '\n';
        i += length;
    }
}

std::size_t line_of_deep_nesting(std::string_view text) {
    int open = 0;
    std::size_t line = 1;
    for (const char c : text) {
        open += (c == '[' || c == '{') - (c == ']' || c == '}');
        if (c == '\n') {
            ++line;
            open = std::max(open, 0);
        }
        if (open > kMaxNesting)
            return line;
    }
    return 0;
}

} // namespace

std::string message_of(const Mention& at, const std::string& accepted) {
    std::string text = at.file + ":" + std::to_string(at.line) + ": ";
    if (!at.key.empty())
        text += at.key + (at.value.empty() ? " is missing: " : " = " + at.value + ": ");
    return text + accepted;
}

TomlTable TomlTable::parse(std::string_view text, std::string_view file) {
    const std::string name(file);
    require_utf8(text, name);
    if (const std::size_t line = line_of_deep_nesting(text); line != 0)
        fail(name, line, "brackets nest too deep: not a file of ours");
    // toml11 asserts on a key or value cut off by the end of the bytes unless a newline follows.
    std::istringstream stream{std::string(text) + "\n"};
    try {
        Node node{toml::parse(stream, name), name};
        return TomlTable(std::make_shared<const Node>(std::move(node)));
    } catch (const toml::syntax_error& error) {
        fail(name, error.location().line(), "not TOML: " + first_line(error.what()));
    } catch (const std::exception& error) {
        fail(name, 1, "not TOML: " + first_line(error.what()));
    }
}

void TomlTable::accept_only(std::initializer_list<std::string_view> keys) const {
    // In the order of the file, so that the first mistake is the one reported.
    const toml::value* first = nullptr;
    std::string first_key;
    for (const auto& [key, value] : node_->value.as_table()) {
        if (std::find(keys.begin(), keys.end(), key) != keys.end())
            continue;
        const bool earlier = first == nullptr || value.location().line() < first->location().line();
        const bool same_line =
            first != nullptr && value.location().line() == first->location().line();
        if (earlier || (same_line && key < first_key)) {
            first = &value;
            first_key = key;
        }
    }
    if (first == nullptr)
        return;
    std::string known;
    for (const std::string_view key : keys)
        known += (known.empty() ? "" : ", ") + std::string(key);
    refuse(first_key, "unknown key; accepted here: " + known);
}

bool TomlTable::has(std::string_view key) const {
    return node_->value.contains(std::string(key));
}

std::string TomlTable::where() const {
    return node_->file + ":" + std::to_string(node_->line);
}

double TomlTable::number(std::string_view key, Range range, std::optional<double> fallback) const {
    const std::string accepted = "a number from " + range_text(range);
    if (!has(key)) {
        if (fallback)
            return *fallback;
        refuse(key, accepted);
    }
    const std::optional<double> value = as_number(node_->value.at(std::string(key)));
    if (!value || !inside(*value, range))
        refuse(key, accepted);
    return *value;
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) const {
    if (!has(key) && fallback)
        return *fallback;
    if (!has(key) || !node_->value.at(std::string(key)).is_string())
        refuse(key, "text in quotes");
    const std::string value = node_->value.at(std::string(key)).as_string().str;
    if (value.empty())
        refuse(key, "text in quotes that is not empty");
    return value;
}

int TomlTable::choice(std::string_view key, const std::vector<std::string>& choices) const {
    std::string accepted;
    for (const std::string& choice : choices)
        accepted += (accepted.empty() ? "one of \"" : "\", \"") + choice;
    accepted += "\"";
    if (!has(key) || !node_->value.at(std::string(key)).is_string())
        refuse(key, accepted);
    const std::string value = node_->value.at(std::string(key)).as_string().str;
    const auto found = std::find(choices.begin(), choices.end(), value);
    if (found == choices.end())
        refuse(key, accepted);
    return static_cast<int>(found - choices.begin());
}

std::vector<std::array<double, 2>> TomlTable::pairs(std::string_view key, std::string_view what,
                                                    std::size_t most, Range first,
                                                    Range second) const {
    const std::string accepted = "[" + std::string(what) + ", ...], 1 to " + std::to_string(most) +
                                 " pairs, the first number " + range_text(first) + ", the second " +
                                 range_text(second);
    if (!has(key) || !node_->value.at(std::string(key)).is_array())
        refuse(key, accepted);
    const toml::array& list = node_->value.at(std::string(key)).as_array();
    if (list.empty() || list.size() > most)
        refuse(key, accepted);
    std::vector<std::array<double, 2>> pairs;
    for (const toml::value& item : list) {
        if (!item.is_array() || item.as_array().size() != 2)
            refuse(key, accepted);
        const auto a = as_number(item.as_array()[0]), b = as_number(item.as_array()[1]);
        if (!a || !b || !inside(*a, first) || !inside(*b, second))
            refuse(key, accepted);
        pairs.push_back({*a, *b});
    }
    return pairs;
}

glm::dvec3 TomlTable::place_mm(std::string_view key, Range range_mm) const {
    const std::string accepted = "[x, y, z] in millimetres, each " + range_text(range_mm);
    if (!has(key) || !node_->value.at(std::string(key)).is_array())
        refuse(key, accepted);
    const toml::array& cells = node_->value.at(std::string(key)).as_array();
    if (cells.size() != 3)
        refuse(key, accepted);
    glm::dvec3 place_m{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> value = as_number(cells[static_cast<std::size_t>(axis)]);
        if (!value || !inside(*value, range_mm))
            refuse(key, accepted);
        place_m[axis] = *value * 1e-3;
    }
    return place_m;
}

TomlTable TomlTable::table(std::string_view key) const {
    if (!has(key) || !node_->value.at(std::string(key)).is_table())
        refuse(key, "a table written as [" + std::string(key) + "]");
    const toml::value& value = node_->value.at(std::string(key));
    Node node{value, node_->file, value.location().line()};
    return TomlTable(std::make_shared<const Node>(std::move(node)));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
    std::vector<TomlTable> found;
    if (!has(key))
        return found;
    const toml::value& list = node_->value.at(std::string(key));
    const std::string accepted = "tables written as [[" + std::string(key) + "]]";
    if (!list.is_array())
        refuse(key, accepted);
    for (const toml::value& item : list.as_array()) {
        if (!item.is_table())
            refuse(key, accepted);
        Node node{item, node_->file, item.location().line()};
        found.push_back(TomlTable(std::make_shared<const Node>(std::move(node))));
    }
    return found;
}

Mention TomlTable::mention(std::string_view key) const {
    const std::string name(key);
    if (!has(key))
        return {node_->file, node_->line, name, {}};
    const toml::value& value = node_->value.at(name);
    const bool tables =
        value.is_array() && !value.as_array().empty() && value.as_array().front().is_table();
    return {node_->file, value.location().line(), name,
            tables ? std::to_string(value.as_array().size()) + " tables" : shown(value)};
}

void TomlTable::refuse(std::string_view key, const std::string& accepted) const {
    throw BadInput(mention(key), accepted);
}

} // namespace tasks
