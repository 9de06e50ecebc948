// assets/bake/import/text_scan.h
// Words and lines of a text of unknown origin, with their line numbers. Called by the readers.
// Allocates nothing but the list of words of one line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bake {

class TextScan {
  public:
    /// `comment`: from this character to the end of the line is skipped; 0: no comments.
    explicit TextScan(std::string_view text, char comment = 0) : text_(text), comment_(comment) {}

    /// Next word, over line ends; empty at the end of the text.
    std::string_view word();
    /// Words of the next line that has any; false at the end of the text.
    bool line_words(std::vector<std::string_view>& words);
    /// The rest of the line is skipped.
    void skip_line();

    [[nodiscard]] std::size_t line() const { return line_; } // of the last word, from 1
    [[nodiscard]] std::size_t offset() const { return at_; } // of the next character
    [[nodiscard]] std::size_t left() const { return text_.size() - at_; }

    /// Throws ReadError: "line 7: WHAT is "WORD": accepted: ACCEPTED".
    [[noreturn]] void refuse(std::string_view what, std::string_view word,
                             std::string_view accepted) const;
    /// A finite number; refuses otherwise.
    double number(std::string_view word, std::string_view what) const;
    std::int64_t integer(std::string_view word, std::string_view what, std::int64_t low,
                         std::int64_t high) const;

  private:
    void skip_space(bool over_lines);

    std::string_view text_;
    char comment_;
    std::size_t at_ = 0, line_ = 1;
};

inline std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A word for a message: at most 40 characters, control characters and quotes replaced.
std::string shown(std::string_view word);

/// ASCII letters only; the same in every locale.
bool same_word(std::string_view a, std::string_view lower_case);

} // namespace bake
