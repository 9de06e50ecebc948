// tests/tasks/trace_test.cpp
// The trace codec: exact, small, and safe on damaged bytes.
#include "tasks/logbook/trace.h"

#include "tasks/logbook/bytes.h"
#include "tests/tasks/logbook_samples.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <zstd.h>

using samples::same;

namespace {

std::vector<tasks::TickTrace> any_ticks(std::size_t count) {
    std::vector<tasks::TickTrace> ticks(count);
    for (tasks::TickTrace& row : ticks) {
        row.tick = *rc::gen::arbitrary<std::int64_t>();
        row.adopted_step = *rc::gen::arbitrary<std::int64_t>();
        for (tasks::ToolTrace& tool : row.tool) {
            tool.counts = *rc::gen::arbitrary<std::array<std::int32_t, 3>>();
            tool.force_mn = *rc::gen::arbitrary<std::array<std::int32_t, 3>>();
            tool.contact_um = *rc::gen::arbitrary<std::array<std::int32_t, 3>>();
            tool.roll_counts = *rc::gen::arbitrary<std::int32_t>();
            tool.jaw_counts = *rc::gen::arbitrary<std::int32_t>();
            tool.flags = *rc::gen::arbitrary<std::uint8_t>();
        }
        row.scope.counts = *rc::gen::arbitrary<std::array<std::int32_t, 3>>();
        row.scope.camera_counts = *rc::gen::arbitrary<std::int32_t>();
        row.scope.optic_counts = *rc::gen::arbitrary<std::int32_t>();
        row.scope.flags = *rc::gen::arbitrary<std::uint8_t>();
    }
    return ticks;
}

std::vector<tasks::StepTrace> any_steps(std::size_t count) {
    std::vector<tasks::StepTrace> steps(count);
    for (tasks::StepTrace& row : steps) {
        row.step = *rc::gen::arbitrary<std::int64_t>();
        row.sample_tick = *rc::gen::arbitrary<std::int64_t>();
        row.duration_us = *rc::gen::arbitrary<std::int32_t>();
        row.flags = *rc::gen::arbitrary<std::uint8_t>();
        row.stress_pa = *rc::gen::arbitrary<std::int32_t>();
        row.targets = *rc::gen::inRange(0, tasks::kMaxTargets + 1);
        for (std::size_t t = 0; t < static_cast<std::size_t>(row.targets); ++t) {
            row.target_um[t] = *rc::gen::arbitrary<std::array<std::int32_t, 3>>();
            row.clear_rays[t] = *rc::gen::arbitrary<std::uint8_t>();
        }
    }
    return steps;
}

// A chunk around a payload of our choice, so that damage gets past the checksum.
std::vector<std::byte> chunk_around(std::span<const std::byte> payload) {
    std::vector<std::byte> bytes{std::byte{'T'}, std::byte{'R'}, std::byte{'C'}, std::byte{2}};
    bytes.resize(4 + ZSTD_compressBound(payload.size()));
    bytes.resize(
        4 + ZSTD_compress(bytes.data() + 4, bytes.size() - 4, payload.data(), payload.size(), 1));
    return bytes;
}

std::vector<std::byte> payload_of(std::span<const std::byte> chunk) {
    std::vector<std::byte> payload(ZSTD_getFrameContentSize(chunk.data() + 4, chunk.size() - 4));
    REQUIRE(ZSTD_decompress(payload.data(), payload.size(), chunk.data() + 4, chunk.size() - 4) ==
            payload.size());
    return payload;
}

struct Tally {
    int decoded = 0, refused = 0;
};

// Decodes or refuses with invalid_argument; anything else ends the test.
void try_decode(std::span<const std::byte> bytes, Tally& tally) {
    try {
        const tasks::Chunk chunk = tasks::decode_chunk(bytes);
        // What is accepted is a real chunk: it survives another round.
        const auto again = tasks::decode_chunk(tasks::encode_chunk(chunk.ticks, chunk.steps));
        CHECK(same(again, chunk.ticks, chunk.steps));
        ++tally.decoded;
    } catch (const std::invalid_argument&) {
        ++tally.refused;
    }
}

std::vector<std::byte> sample_chunk() {
    samples::Motion motion(7);
    std::vector<tasks::TickTrace> ticks;
    std::vector<tasks::StepTrace> steps;
    motion.second(ticks, steps);
    ticks.resize(30);
    steps.resize(3);
    return tasks::encode_chunk(ticks, steps);
}

} // namespace

TEST_CASE("a chunk gives back every tick and step exactly, whatever the integers") {
    CHECK(rc::check("round trip", [] {
        const auto ticks = any_ticks(*rc::gen::inRange<std::size_t>(0, 12));
        const auto steps = any_steps(*rc::gen::inRange<std::size_t>(0, 6));
        RC_ASSERT(same(tasks::decode_chunk(tasks::encode_chunk(ticks, steps)), ticks, steps));
    }));
}

TEST_CASE("a column may jump from the smallest to the largest integer and back") {
    std::vector<tasks::TickTrace> ticks(3);
    ticks[0].tick = std::numeric_limits<std::int64_t>::min();
    ticks[1].tick = std::numeric_limits<std::int64_t>::max();
    ticks[0].tool[2].force_mn[1] = std::numeric_limits<std::int32_t>::max();
    ticks[1].tool[2].force_mn[1] = std::numeric_limits<std::int32_t>::min();
    CHECK(same(tasks::decode_chunk(tasks::encode_chunk(ticks, {})), ticks, {}));
}

TEST_CASE("places beyond the number of targets are not kept") {
    std::vector<tasks::StepTrace> steps(1);
    steps[0].targets = 1;
    steps[0].target_um[0] = {1, 2, 3};
    steps[0].target_um[1] = {4, 5, 6};
    steps[0].clear_rays = {7, 7};
    const tasks::Chunk chunk = tasks::decode_chunk(tasks::encode_chunk({}, steps));
    CHECK(chunk.steps[0].clear_rays[0] == 7);
    CHECK(chunk.steps[0].clear_rays[1] == 0);
    CHECK(chunk.steps[0].target_um[0] == std::array<std::int32_t, 3>{1, 2, 3});
    CHECK(chunk.steps[0].target_um[1] == std::array<std::int32_t, 3>{0, 0, 0});
}

TEST_CASE("ten minutes of three trembling tools take less than 10 MB") {
    // One minute is made; ten are ten times that, since every second stands alone. The station's
    // budget is 25 MB, the target 10 MB.
    samples::Motion motion(1);
    std::vector<tasks::TickTrace> ticks;
    std::vector<tasks::StepTrace> steps;
    std::size_t bytes = 0;
    bool exact = true;
    for (int second = 0; second < 60; ++second) {
        motion.second(ticks, steps);
        const auto chunk = tasks::encode_chunk(ticks, steps);
        bytes += chunk.size();
        exact = exact && same(tasks::decode_chunk(chunk), ticks, steps);
    }
    CHECK(exact);
    MESSAGE("one minute: " << bytes << " bytes");
    CHECK(10 * bytes < 10'000'000);
}

TEST_CASE("a recording of format 1, from before there was an endoscope, is read as it was") {
    // written by the last build of that format: two ticks, one step with two targets
    const std::string_view hex =
        "5452430128b52ffd2465850200d40302010e02010800020002fff0040000000a00050000020000d00f00040"
        "0c801010004000202060090030300040004040800060c88270204020406070a0b0700200890354802f682ac"
        "fdcc6acb8101cc6bf68e";
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        bytes.push_back(
            static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    std::vector<tasks::TickTrace> ticks(2);
    for (int i = 0; i < 2; ++i) {
        ticks[i].tick = 7 + i;
        ticks[i].adopted_step = i == 0 ? -1 : 3;
        for (int k = 0; k < 3; ++k)
            ticks[i].tool[k] = {.counts = {100 * k + i, -k, 5},
                                .roll_counts = k,
                                .jaw_counts = 1000,
                                .force_mn = {i, 2, -3},
                                .contact_um = {-40000, k, i},
                                .flags = static_cast<std::uint8_t>(2 + k)};
    }
    std::vector<tasks::StepTrace> steps(1);
    steps[0] = {.step = 3, .sample_tick = 6, .duration_us = 2500, .flags = 1, .targets = 2};
    steps[0].target_um[0] = {1, 2, 3};
    steps[0].target_um[1] = {-4, 5, -6};
    CHECK(same(tasks::decode_chunk(bytes), ticks, steps));
    bytes[3] = std::byte{3};
    CHECK_THROWS_WITH_AS(tasks::decode_chunk(bytes), doctest::Contains("formats 1 and 2"),
                         std::invalid_argument);
}

TEST_CASE("the encoder refuses what the decoder would") {
    std::vector<tasks::StepTrace> steps(1);
    steps[0].targets = tasks::kMaxTargets + 1;
    CHECK_THROWS_AS(tasks::encode_chunk({}, steps), std::invalid_argument);
    steps[0].targets = -1;
    CHECK_THROWS_AS(tasks::encode_chunk({}, steps), std::invalid_argument);
    const std::vector<tasks::TickTrace> full(10'000), too_many(10'001);
    CHECK(tasks::decode_chunk(tasks::encode_chunk(full, {})).ticks.size() == 10'000);
    CHECK_THROWS_AS(tasks::encode_chunk(too_many, {}), std::invalid_argument);
}

TEST_CASE("one damaged byte anywhere in a chunk never changes what is read from it") {
    const std::vector<std::byte> good = sample_chunk();
    const tasks::Chunk chunk = tasks::decode_chunk(good);
    std::size_t refused = 0, harmless = 0;
    for (std::size_t at = 0; at < good.size(); ++at)
        for (const unsigned bits : {0x01U, 0x80U, 0xffU}) {
            auto bad = good;
            bad[at] ^= static_cast<std::byte>(bits);
            try {
                // zstd has a few bits that carry nothing: padding, unused tables.
                const tasks::Chunk read = tasks::decode_chunk(bad); // CHECK would eat the throw
                CHECK(same(read, chunk.ticks, chunk.steps));
                ++harmless;
            } catch (const std::invalid_argument&) {
                ++refused;
            }
        }
    CHECK(refused > 90 * harmless);
}

TEST_CASE("a chunk cut short at any byte, or with a byte too many, is refused") {
    const std::vector<std::byte> good = sample_chunk();
    for (std::size_t size = 0; size < good.size(); ++size)
        CHECK_THROWS_AS(tasks::decode_chunk(std::span(good).first(size)), std::invalid_argument);
    auto longer = good;
    longer.push_back(std::byte{0});
    CHECK_THROWS_AS(tasks::decode_chunk(longer), std::invalid_argument);
    auto two_frames = good; // zstd alone would read on into a second frame
    const auto empty = chunk_around({});
    two_frames.insert(two_frames.end(), empty.begin() + 4, empty.end());
    CHECK_THROWS_AS(tasks::decode_chunk(two_frames), std::invalid_argument);
}

TEST_CASE("damage behind a correct checksum decodes or is refused, never worse") {
    const std::vector<std::byte> payload = payload_of(sample_chunk());
    std::mt19937 random(42);
    Tally tally;
    for (int round = 0; round < 3000; ++round) {
        auto bad = payload;
        for (unsigned edits = 1 + random() % 4; edits > 0; --edits) {
            const std::size_t at = random() % bad.size();
            switch (random() % 3) {
            case 0:
                bad[at] = static_cast<std::byte>(random() & 0xff);
                break;
            case 1:
                bad.insert(bad.begin() + static_cast<std::ptrdiff_t>(at), std::byte{0xff});
                break;
            default:
                bad.erase(bad.begin() + static_cast<std::ptrdiff_t>(at));
            }
        }
        try_decode(chunk_around(bad), tally);
    }
    CHECK(tally.decoded > 0); // a changed delta is another motion
    CHECK(tally.refused > 0); // a missing byte is not a motion
}

TEST_CASE("sizes that the bytes cannot fill are refused before memory is taken") {
    std::vector<std::byte> payload;
    tasks::put_varint(payload, 10'000);
    tasks::put_varint(payload, 0);
    CHECK_THROWS_WITH_AS(tasks::decode_chunk(chunk_around(payload)),
                         doctest::Contains("claims 10000 ticks"), std::invalid_argument);
    payload.clear();
    tasks::put_varint(payload, std::uint64_t{1} << 63); // times an even number of columns: 0
    tasks::put_varint(payload, 0);
    CHECK_THROWS_WITH_AS(tasks::decode_chunk(chunk_around(payload)),
                         doctest::Contains("claims 9223372036854775808 ticks"),
                         std::invalid_argument);
    const std::vector<std::byte> bomb(50'000'000); // compresses to a few kB
    CHECK_THROWS_WITH_AS(tasks::decode_chunk(chunk_around(bomb)),
                         doctest::Contains("claims 50000000 bytes"), std::invalid_argument);
}

TEST_CASE("a payload with a byte after its last column is refused") {
    std::vector<std::byte> payload = payload_of(sample_chunk());
    payload.push_back(std::byte{0});
    CHECK_THROWS_WITH_AS(tasks::decode_chunk(chunk_around(payload)),
                         doctest::Contains("1 bytes after the last column"), std::invalid_argument);
}

TEST_CASE("a value that does not fit its column is refused") {
    std::vector<std::byte> payload;
    tasks::put_varint(payload, 1);
    tasks::put_varint(payload, 0);
    for (int column = 0; column < 38; ++column) // the first count of the first tool is the third
        tasks::put_varint(payload, column == 2 ? tasks::zigzag(std::int64_t{1} << 31) : 0);
    CHECK_THROWS_WITH_AS(tasks::decode_chunk(chunk_around(payload)),
                         doctest::Contains("2147483648 does not fit"), std::invalid_argument);
}

TEST_CASE("varints follow the base-128 layout and refuse more than 64 bits") {
    std::vector<std::byte> bytes;
    tasks::put_varint(bytes, 300); // 0b10'0101100
    CHECK(bytes == std::vector<std::byte>{std::byte{0xac}, std::byte{0x02}});
    const std::vector<std::byte> eleven(11, std::byte{0x80});
    CHECK_THROWS_AS(tasks::VarintReader(eleven).next(), std::invalid_argument);
    std::vector<std::byte> wide(9, std::byte{0xff});
    wide.push_back(std::byte{0x01});
    CHECK(tasks::VarintReader(wide).next() == ~std::uint64_t{0});
    wide.back() = std::byte{0x02};
    CHECK_THROWS_AS(tasks::VarintReader(wide).next(), std::invalid_argument);
    for (const std::int64_t value :
         {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1},
          std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
        CHECK(tasks::unzigzag(tasks::zigzag(value)) == value);
    CHECK(tasks::zigzag(-2) == 3);
}
