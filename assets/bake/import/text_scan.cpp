#include "assets/bake/import/text_scan.h"

#include "assets/bake/import/soup.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace bake {
namespace {

constexpr std::size_t kLongestShown = 40;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

std::string_view without_plus(std::string_view word) {
    return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

} // namespace

void TextScan::skip_space(bool over_lines) {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (comment_ != 0 && c == comment_) {
            while (at_ < text_.size() && text_[at_] != '\n') {
                ++at_;
            }
        } else if (is_space(c) || (c == '\n' && over_lines)) {
            line_ += c == '\n' ? 1 : 0;
            ++at_;
        } else {
            break;
        }
    }
}

std::string_view TextScan::word() {
    skip_space(true);
    const std::size_t first = at_;
    while (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != '\n' &&
           (comment_ == 0 || text_[at_] != comment_)) {
        ++at_;
    }
    return text_.substr(first, at_ - first);
}

bool TextScan::line_words(std::vector<std::string_view>& words) {
    words.clear();
    skip_space(true);
    while (at_ < text_.size() && text_[at_] != '\n') {
        words.push_back(word());
        skip_space(false);
    }
    return !words.empty();
}

void TextScan::skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') {
        ++at_;
    }
}

void TextScan::refuse(std::string_view what, std::string_view word,
                      std::string_view accepted) const {
    if (word.empty()) {
        throw ReadError(
            fmt::format("line {}: the file ends before {}: accepted: {}", line_, what, accepted));
    }
    throw ReadError(
        fmt::format("line {}: {} is \"{}\": accepted: {}", line_, what, shown(word), accepted));
}

double TextScan::number(std::string_view word, std::string_view what) const {
    double value = 0.0;
    const std::string_view digits = without_plus(word);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
        refuse(what, word, "a finite number");
    }
    return value;
}

std::int64_t TextScan::integer(std::string_view word, std::string_view what, std::int64_t low,
                               std::int64_t high) const {
    std::int64_t value = 0;
    const std::string_view digits = without_plus(word);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value < low ||
        value > high) {
        refuse(what, word, fmt::format("a whole number from {} to {}", low, high));
    }
    return value;
}

std::string shown(std::string_view word) {
    std::string text;
    for (const char c : word.substr(0, kLongestShown)) {
        const bool plain = c >= ' ' && c != '"' && c != '\x7F';
        text += plain ? c : '?';
    }
    return word.size() > kLongestShown ? text + "..." : text;
}

bool same_word(std::string_view a, std::string_view lower_case) {
    if (a.size() != lower_case.size()) {
        return false;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        const char c = a[i] >= 'A' && a[i] <= 'Z' ? static_cast<char>(a[i] - 'A' + 'a') : a[i];
        if (c != lower_case[i]) {
            return false;
        }
    }
    return true;
}

} // namespace bake
