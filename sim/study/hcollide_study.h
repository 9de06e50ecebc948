// sim/study/hcollide_study.h
// trocar study contact: the table of H-Collide (Gregory, Lin, Gottschalk, Taylor 1999) for our
// collision methods, with and without a witness, on stand-ins for its three models, at rest and
// deforming. Times of a query and the work that is behind them.
#pragma once

#include "haptics/collision/counted.h"
#include "sim/study/contact_stand_ins.h"

#include <filesystem>
#include <string>

namespace sim {

struct HcollideOptions {
    std::uint64_t seed = 1;
    int queries = 4000; // of each kind, per mesh: ticks of 1 ms
    int rounds = 5;     // a query's time is the least of so many: what else ran is left out
};

struct QueryCost {
    std::uint64_t count = 0;
    double sum_us = 0.0, worst_us = 0.0;
    void add(double us) noexcept;
    double mean_us() const noexcept { return count ? sum_us / static_cast<double>(count) : 0.0; }
};

inline constexpr std::array<std::string_view, 4> kQueryKinds{
    "collision hit", "collision miss", "intersection hit", "intersection miss"};

struct HcollideRow {
    std::string mesh, method;
    bool deforming = false, witness = false;
    std::array<QueryCost, 4> kind; // in the order of kQueryKinds
    QueryCost all, refit;
    haptics::VisitCounts counts; // of all queries
    std::uint64_t different = 0; // answers unlike the first method's
};

struct HcollideStudy {
    std::vector<HcollideRow> row;
    double clock_us = 0.0; // what reading the clock takes; is in every time
};

/// `progress` hears of each mesh.
HcollideStudy run_hcollide_study(const HcollideOptions& options,
                                 void (*progress)(const std::string& what));

/// CSV, a Markdown page and a chart.
void write_hcollide_study(const HcollideOptions& options, const HcollideStudy& study,
                          const std::filesystem::path& out);

} // namespace sim
