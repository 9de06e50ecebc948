#include "sim/io/trajectory_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace sim {
namespace {

constexpr std::array<std::string_view, 4> kColumns{"t", "x", "y", "z"};
constexpr std::string_view kBlank = " \t\r";

[[noreturn]] void refuse(const std::string& file, std::size_t line, const std::string& what) {
    throw std::runtime_error(fmt::format("{}: line {}: {}", file, line, what));
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlank);
    return first == std::string_view::npos
               ? std::string_view{}
               : text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

/// What a message can show of foreign bytes.
std::string shown(std::string_view cell) {
    std::string out(cell.substr(0, 40));
    for (char& c : out)
        if (c < ' ' || c > '~')
            c = '?';
    return out;
}

/// Cells of one line; a quoted cell may hold commas.
void split(std::string_view line, std::vector<std::string_view>& cells, const std::string& file,
           std::size_t number) {
    cells.clear();
    for (bool more = true; more;) {
        line = line.substr(std::min(line.find_first_not_of(kBlank), line.size()));
        const bool quoted = line.starts_with('"');
        std::size_t end = line.find(quoted ? '"' : ',', quoted ? 1 : 0);
        if (quoted && end == std::string_view::npos)
            refuse(file, number, "a quotation mark does not close");
        cells.push_back(quoted ? trimmed(line.substr(1, end - 1)) : trimmed(line.substr(0, end)));
        if (quoted)
            end = line.find(',', end);
        more = end != std::string_view::npos;
        if (more)
            line.remove_prefix(end + 1);
    }
}

std::array<std::size_t, 4> columns_of(const std::vector<std::string_view>& header,
                                      const std::string& file, std::size_t number) {
    std::array<std::optional<std::size_t>, 4> at;
    for (std::size_t cell = 0; cell < header.size(); ++cell)
        for (std::size_t k = 0; k < kColumns.size(); ++k)
            if (header[cell] == kColumns[k]) {
                if (at[k])
                    refuse(file, number, fmt::format("column \"{}\" is there twice", kColumns[k]));
                at[k] = cell;
            }
    std::array<std::size_t, 4> out{};
    for (std::size_t k = 0; k < kColumns.size(); ++k) {
        if (!at[k])
            refuse(
                file, number,
                fmt::format("column \"{}\" is missing: accepted: a header with t, x, y, z (s, m)",
                            kColumns[k]));
        out[k] = *at[k];
    }
    return out;
}

double number_of(std::string_view cell, std::string_view column, const std::string& file,
                 std::size_t number) {
    double value = 0.0;
    const char* const end = cell.data() + cell.size();
    const char* const begin = cell.data() + (cell.size() > 1 && cell[0] == '+' && cell[1] != '-');
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (cell.empty() || error != std::errc{} || rest != end || !std::isfinite(value))
        refuse(file, number,
               fmt::format("{} is \"{}\": accepted: a finite number", column, shown(cell)));
    return value;
}

} // namespace

std::vector<TrajectorySample> read_trajectory(std::span<const std::byte> bytes,
                                              const std::string& file_name) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\xef\xbb\xbf")) // a byte order mark
        text.remove_prefix(3);
    std::optional<std::array<std::size_t, 4>> column;
    std::vector<TrajectorySample> out;
    std::vector<std::string_view> cells;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view row = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (trimmed(row).empty())
            continue;
        split(row, cells, file_name, line);
        if (!column) {
            column = columns_of(cells, file_name, line);
            continue;
        }
        std::array<double, 4> value{};
        for (std::size_t k = 0; k < kColumns.size(); ++k) {
            if ((*column)[k] >= cells.size())
                refuse(file_name, line, fmt::format("{} is missing", kColumns[k]));
            value[k] = number_of(cells[(*column)[k]], kColumns[k], file_name, line);
        }
        if (!out.empty() && !(value[0] > out.back().time_s))
            refuse(file_name, line,
                   fmt::format("t is {}, after {}: accepted: times in order", value[0],
                               out.back().time_s));
        out.push_back({value[0], {value[1], value[2], value[3]}});
    }
    if (out.empty())
        throw std::runtime_error(
            file_name + ": has no rows: accepted: a header with t, x, y, z (s, m) and rows below");
    return out;
}

std::vector<glm::dvec3> at_ticks(std::span<const TrajectorySample> trajectory) {
    const double begin_s = trajectory.front().time_s;
    const double lasts_s = trajectory.back().time_s - begin_s;
    if (!(lasts_s <= 3600.0))
        throw std::invalid_argument(
            fmt::format("a trajectory of {} s: accepted: 3600 s at most", lasts_s));
    std::vector<glm::dvec3> out;
    std::size_t next = 0; // the first sample that is later
    // half a microsecond of grace: times in milliseconds are no binary fractions
    for (int tick = 0; 1e-3 * tick <= lasts_s + 5e-7; ++tick) {
        const double t = begin_s + 1e-3 * tick;
        while (next < trajectory.size() && trajectory[next].time_s <= t)
            ++next;
        if (next == trajectory.size()) {
            out.push_back(trajectory.back().place_m);
            continue;
        }
        const TrajectorySample &a = trajectory[next > 0 ? next - 1 : 0], &b = trajectory[next];
        const double share = next > 0 ? (t - a.time_s) / (b.time_s - a.time_s) : 0.0;
        out.push_back(a.place_m + share * (b.place_m - a.place_m));
    }
    return out;
}

} // namespace sim
