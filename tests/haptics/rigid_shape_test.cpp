#include "haptics/rigid/rigid_shape.h"

#include "haptics/rigid/separation.h"
#include "tests/haptics/convex_pieces.h"

#include <doctest/doctest.h>
#include <set>

namespace {

using haptics::ConvexHull;
using haptics::PairList;
using haptics::RigidPose;
using haptics::RigidShape;

RigidShape cloud_of_boxes(RandomPieces& random, int n) {
    std::vector<ConvexHull> piece;
    for (int i = 0; i < n; ++i)
        piece.push_back(box(4e-3 * (random.in_ball() + 1.2), 0.03 * random.in_ball()));
    return haptics::make_shape("boxes", piece);
}

} // namespace

TEST_CASE("rigid shape: the pairs closer than the margin are all found, and no others") {
    RandomPieces random(70);
    std::size_t most = 0;
    for (int i = 0; i < 60; ++i) {
        const RigidShape a = cloud_of_boxes(random, 1 + i % 12), b = cloud_of_boxes(random, 7);
        const RigidPose pose{random.rotation(), 0.04 * random.in_ball()};
        const double margin_m = random.number(0.0, 8e-3);
        PairList found;
        haptics::close_pairs(a, b, pose, margin_m, found);
        std::set<std::pair<std::uint32_t, std::uint32_t>> ours, all;
        for (const haptics::PiecePair& p : found)
            ours.insert({p.a, p.b});
        for (std::uint32_t p = 0; p < a.piece.size(); ++p)
            for (std::uint32_t q = 0; q < b.piece.size(); ++q) {
                const auto s = haptics::separation(a.piece[p], b.piece[q], pose, {1, 0, 0}, 1e300);
                if (!s.apart || s.distance_m <= margin_m)
                    all.insert({p, q});
            }
        CHECK(ours == all);
        CHECK(ours.size() == found.count);
        CHECK(found.dropped == 0);
        most = std::max(most, all.size());
    }
    CHECK(most > 10);
}

TEST_CASE("rigid shape: what does not fit is counted; nothing is near nothing") {
    RandomPieces random(71);
    const RigidShape a = cloud_of_boxes(random, 15), none = haptics::make_shape("none", {});
    PairList found;
    haptics::close_pairs(a, a, {}, 1.0, found);
    CHECK(found.count == 128);
    CHECK(found.count + found.dropped == 15 * 15);
    haptics::close_pairs(a, none, {}, 1.0, found);
    CHECK(found.count == 0);
}
