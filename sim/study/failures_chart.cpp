#include "sim/study/failures_chart.h"

#include "sim/study/svg_parts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace sim {
namespace {

/// Largest measured over gate; a gate of 0 allows nothing, so anything above is beyond any ratio.
double over_gate(const FailureRow& r) {
    if (!std::isfinite(r.measured))
        return INFINITY;
    if (r.near)
        return std::abs(r.measured / r.bound - 1.0) / r.tolerance;
    if (r.bound > 0.0)
        return r.measured / r.bound;
    return r.measured > 0.0 ? INFINITY : 0.0;
}

std::string number(double v) {
    if (v < 1e-3)
        return v > 0.0 ? "< 0.001" : "0";
    if (v >= 1e4)
        return fmt::format("{:.1e}", v);
    if (v >= 10.0)
        return fmt::format("{:.0f}", v);
    return std::abs(v - 1.0) < 0.01 ? fmt::format("{:.4f}", v) : fmt::format("{:.2g}", v);
}

/// A ratio tells more than a count that should be 0, and a gate more than that theory was met.
std::string worst_of(const std::vector<const FailureRow*>& rows) {
    const FailureRow *gated = nullptr, *none_allowed = nullptr, *theory = nullptr;
    for (const FailureRow* r : rows) {
        if (!std::isfinite(r->measured))
            return "not finite";
        const FailureRow*& best = r->near ? theory : r->bound > 0.0 ? gated : none_allowed;
        const bool more = best && (&best == &none_allowed ? r->measured > best->measured
                                                          : over_gate(*r) > over_gate(*best));
        if (!best || more)
            best = r;
    }
    if (gated)
        return fmt::format("worst {} x gate", number(over_gate(*gated)));
    if (none_allowed)
        return fmt::format("worst {:.4g}, gate 0", none_allowed->measured);
    return fmt::format("off theory by {} %",
                       number(100.0 * std::abs(theory->measured / theory->bound - 1.0)));
}

FailureVerdict verdict_of(const FailureRow& r) {
    if (!r.passed)
        return FailureVerdict::unexpected;
    return r.wrong_expected ? FailureVerdict::fails_as_known : FailureVerdict::holds;
}

constexpr double kMargin = 16.0, kLabel = 300.0, kCell = 172.0, kHigh = 56.0, kGap = 4.0;
constexpr double kName = 17.0; // of the method, in a cell that has no column of its own
constexpr double kSign = 34.0; // left of a cell's words
constexpr double kLine = 18.0;

/// Told apart with any colour vision (Okabe, Ito 2008), and printed grey.
struct Look {
    const char *name, *words, *fill, *edge, *ink, *sign;
};

constexpr const char* kHook = "M2 8 L6 12 L13 3";
constexpr const char* kCross = "M3 3 L12 12 M12 3 L3 12";
constexpr const char* kWarning = "M7.5 1 L14.5 14 L0.5 14 Z M7.5 5 L7.5 9.5 M7.5 11.2 L7.5 12.4";

const Look& look_of(FailureVerdict verdict) {
    static constexpr Look kLooks[]{
        {"holds", "every check stays within its gate", "#d7ebf8", "#0072b2", "#000000", kHook},
        {"fails as known",
         "the published weakness shows, with theory's value where there is one; other checks hold",
         "#f5c77e", "#7a4a00", "#000000", kCross},
        {"UNEXPECTED", "a check fails that should hold, or holds that is known to fail", "#8c1d04",
         "#000000", "#ffffff", kWarning}};
    return kLooks[static_cast<int>(verdict)];
}

/// Words in a width: the letters of the widest common sans-serif face (DejaVu) are 0.6 high on
/// average, bold ones 0.7.
std::string fitted(double x, double y, double width, double size, std::string_view words,
                   const char* ink, bool bold = false) {
    const double letters = static_cast<double>(std::max<std::size_t>(words.size(), 1));
    return svg_text(x, y, "start", words,
                    fmt::format("font-size=\"{:.1f}\" fill=\"{}\"{}",
                                std::min(size, width / ((bold ? 0.7 : 0.6) * letters)), ink,
                                bold ? " font-weight=\"bold\"" : ""));
}

std::string sign(double x, double y, const Look& look) {
    return fmt::format("<path d=\"{}\" transform=\"translate({:.1f} {:.1f})\" fill=\"none\" "
                       "stroke=\"{}\" stroke-width=\"2.5\"/>\n",
                       look.sign, x, y,
                       look.ink == std::string_view("#ffffff") ? look.ink : look.edge);
}

std::string box(double x, double y, double width, double height, const Look& look,
                const char* kind) {
    return fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                       "height=\"{:.1f}\" fill=\"{}\" stroke=\"{}\"/>\n",
                       kind, x, y, width, height, look.fill, look.edge);
}

std::string cell_svg(double x, double y, const FailureCell& cell, bool named) {
    const Look& look = look_of(cell.verdict);
    const double width = kCell - kGap, name = named ? kName : 0.0;
    const double words = width - kSign - 4.0;
    std::string out = box(x, y, width, kHigh - kGap + name, look, "cell");
    if (named)
        out += fitted(x + 8.0, y + 15.0, width - 12.0, 11.0, cell.method, look.ink);
    y += name;
    out += sign(x + 10.0, y + 18.0, look);
    out += fitted(x + kSign, y + 16.0, words, 12.0, look.name, look.ink, true);
    out += fitted(x + kSign, y + 31.0, words, 11.0,
                  fmt::format("{} of {} checks", cell.counted, cell.checks), look.ink);
    return out + fitted(x + kSign, y + 46.0, words, 11.0, cell.worst, look.ink);
}

std::string label_svg(double y, const FailureScene& scene) {
    return fitted(kMargin, y + 20.0, kLabel - 8.0, 13.0, scene.name, "#000000", true) +
           fitted(kMargin, y + 36.0, kLabel - 8.0, 11.0, scene.about, "#000000");
}

using Cells = std::vector<const FailureCell*>;

bool has_column(const FailureCell& cell) {
    return std::any_of(kContactMethods.begin(), kContactMethods.end(),
                       [&](const ContactMethod& m) { return m.name == cell.method; });
}

/// Cells of one scene: those with a column, or the others.
Cells cells_of(const std::vector<FailureCell>& all, std::string_view scene, bool column) {
    Cells out;
    for (const FailureCell& cell : all)
        if (cell.scene == scene && has_column(cell) == column)
            out.push_back(&cell);
    return out;
}

/// Scenes below each other from y on; moves it.
std::string matrix_svg(std::span<const FailureScene> scenes, const std::vector<FailureCell>& all,
                       double& y) {
    std::string out;
    for (std::size_t m = 0; m < kContactMethods.size(); ++m)
        out += fitted(kMargin + kLabel + kCell * static_cast<double>(m), y + 14.0, kCell - kGap,
                      13.0, kContactMethods[m].name, "#000000", true);
    y += 22.0;
    for (const FailureScene& scene : scenes) {
        const Cells cells = cells_of(all, scene.name, true);
        if (cells.empty())
            continue;
        out += label_svg(y, scene);
        for (const FailureCell* cell : cells) {
            double x = kMargin + kLabel;
            for (std::size_t m = 0; kContactMethods[m].name != cell->method; ++m)
                x += kCell;
            out += cell_svg(x, y, *cell, false);
        }
        y += kHigh;
    }
    return out;
}

std::string others_svg(std::span<const FailureScene> scenes, const std::vector<FailureCell>& all,
                       std::size_t columns, double& y) {
    std::string out;
    for (const FailureScene& scene : scenes) {
        const Cells cells = cells_of(all, scene.name, false);
        if (cells.empty())
            continue;
        out += label_svg(y, scene);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (i > 0 && i % columns == 0)
                y += kHigh + kName;
            out += cell_svg(kMargin + kLabel + kCell * static_cast<double>(i % columns), y,
                            *cells[i], true);
        }
        y += kHigh + kName;
    }
    return out;
}

} // namespace

std::vector<FailureCell> failure_cells(const std::vector<FailureRow>& rows) {
    std::vector<FailureCell> out;
    for (const FailureRow& r : rows)
        if (std::none_of(out.begin(), out.end(), [&](const FailureCell& c) {
                return c.scene == r.scene && c.method == r.method;
            }))
            out.push_back({.scene = r.scene, .method = r.method});
    for (FailureCell& cell : out) {
        std::vector<const FailureRow*> own, counted;
        for (const FailureRow& r : rows)
            if (r.scene == cell.scene && r.method == cell.method) {
                own.push_back(&r);
                cell.verdict = std::max(cell.verdict, verdict_of(r));
            }
        std::copy_if(own.begin(), own.end(), std::back_inserter(counted),
                     [&](const FailureRow* r) { return verdict_of(*r) == cell.verdict; });
        cell.checks = static_cast<int>(own.size());
        cell.counted = static_cast<int>(counted.size());
        cell.worst = worst_of(counted);
    }
    return out;
}

std::string failures_svg(std::span<const FailureScene> scenes, const std::vector<FailureRow>& rows,
                         std::span<const std::string> caption) {
    const std::vector<FailureCell> cells = failure_cells(rows);
    constexpr std::size_t kMostOthers = 5; // of a scene beside each other
    const std::size_t columns = std::max(kContactMethods.size(), kMostOthers);
    const double width = 2.0 * kMargin + kLabel + kCell * static_cast<double>(columns);
    const double room = width - 2.0 * kMargin;
    double y = 16.0;
    std::string out =
        fitted(kMargin, y + 14.0, room, 17.0, "Failure scenes: what each method does", "#000000");
    y += 30.0;
    const auto part = [&](std::string_view heading, bool any, const auto& draw) {
        if (!any)
            return;
        out += fitted(kMargin, y + 16.0, room, 13.0, heading, "#444444");
        y += 26.0;
        out += draw();
        y += 10.0;
    };
    part("A ball led over a mesh", std::any_of(cells.begin(), cells.end(), has_column),
         [&] { return matrix_svg(scenes, cells, y); });
    part("What else is known to fail, or to hold, in these scenes",
         !std::all_of(cells.begin(), cells.end(), has_column),
         [&] { return others_svg(scenes, cells, columns, y); });
    for (const FailureVerdict v :
         {FailureVerdict::holds, FailureVerdict::fails_as_known, FailureVerdict::unexpected}) {
        const Look& look = look_of(v);
        out += box(kMargin, y, 26.0, kLine + 2.0, look, "legend") +
               sign(kMargin + 5.0, y + 2.0, look) +
               fitted(kMargin + 36.0, y + 14.0, room - 36.0, 12.0,
                      fmt::format("{}: {}", look.name, look.words), "#000000");
        y += kLine + 8.0;
    }
    for (const std::string& line : caption) {
        out += fitted(kMargin, y + 14.0, room, 12.0, line, "#444444");
        y += kLine;
    }
    return svg_sheet(width, y + kMargin, 12) + out + "</svg>\n";
}

} // namespace sim
