// tasks/logbook/trace.cpp
// Chunks of the trace: columns of deltas, zigzag, varint, one zstd frame. Called by the recorder
// (not the 1 kHz thread), by replay, re-score and review.
//
//   chunk   = "TRC" version(1 byte) frame
//   frame   = one zstd frame with content size and checksum, holding:
//             varint ticks, varint steps, tick columns, step columns
//   column  = for every row: varint(zigzag(value - value of the row before, first 0)), mod 2^64
//   columns = in the order of tick_columns() and step_columns(); then, for every target index t,
//             x, y and z over the steps that have more than t targets
//   format 2 ends with the endoscope's columns, stress and, for every target index, clear rays;
//   what a recording of format 1 does not have is zero
#include "tasks/logbook/trace.h"

#include "tasks/logbook/bytes.h"

#include <limits>
#include <memory>
#include <zstd.h>

namespace tasks {
namespace {

constexpr std::array<std::byte, 4> kMagic{std::byte{'T'}, std::byte{'R'}, std::byte{'C'},
                                          std::byte{2}};
// A chunk holds one second; ten leave room for a recorder that came late.
constexpr std::size_t kMaxRows = 10'000;
// Worst case: all columns of kMaxRows ticks and steps, ten bytes each, is below 12 MB.
constexpr std::size_t kMaxRawBytes = 12'000'000;
constexpr int kZstdLevel = 6; // on seeded motion 12 saves 1 % for three times the time

[[noreturn]] void refuse(const std::string& why) {
    throw std::invalid_argument("trace: " + why);
}

// The columns in file order, one list for both directions: `column(get)`, get(row) -> number&.
template <class Column> void tick_columns(Column&& column) {
    column([](auto& row) -> auto& { return row.tick; });
    column([](auto& row) -> auto& { return row.adopted_step; });
    for (std::size_t t = 0; t < kTools; ++t) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            column([=](auto& row) -> auto& { return row.tool[t].counts[axis]; });
            column([=](auto& row) -> auto& { return row.tool[t].force_mn[axis]; });
            column([=](auto& row) -> auto& { return row.tool[t].contact_um[axis]; });
        }
        column([=](auto& row) -> auto& { return row.tool[t].roll_counts; });
        column([=](auto& row) -> auto& { return row.tool[t].jaw_counts; });
        column([=](auto& row) -> auto& { return row.tool[t].flags; });
    }
}
constexpr std::size_t kTickColumns = 2 + std::size_t{kTools} * 12;

template <class Column> void step_columns(Column&& column) {
    column([](auto& row) -> auto& { return row.step; });
    column([](auto& row) -> auto& { return row.sample_tick; });
    column([](auto& row) -> auto& { return row.duration_us; });
    column([](auto& row) -> auto& { return row.flags; });
    column([](auto& row) -> auto& { return row.targets; });
}
constexpr std::size_t kStepColumns = 5;

template <class Column> void scope_columns(Column&& column) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        column([=](auto& row) -> auto& { return row.scope.counts[axis]; });
    column([](auto& row) -> auto& { return row.scope.camera_counts; });
    column([](auto& row) -> auto& { return row.scope.optic_counts; });
    column([](auto& row) -> auto& { return row.scope.flags; });
}
constexpr std::size_t kScopeColumns = 6;
static_assert(kMaxRows * 10 *
                  (kTickColumns + kScopeColumns + kStepColumns + 1 + 4 * std::size_t{kMaxTargets}) <
              kMaxRawBytes);

template <class Column> void sight_columns(Column&& column) {
    for (std::size_t t = 0; t < kMaxTargets; ++t)
        column(
            static_cast<int>(t), [=](auto& row) -> auto& { return row.clear_rays[t]; });
}

template <class Column> void target_columns(Column&& column) {
    for (std::size_t t = 0; t < kMaxTargets; ++t)
        for (std::size_t axis = 0; axis < 3; ++axis)
            column(
                static_cast<int>(t), [=](auto& row) -> auto& { return row.target_um[t][axis]; });
}

class ColumnWriter {
  public:
    std::vector<std::byte> bytes;

    template <class Row, class Get, class Has>
    void column(std::span<const Row> rows, Get get, Has has) {
        std::uint64_t before = 0;
        for (const Row& row : rows) {
            if (!has(row))
                continue;
            const auto value = static_cast<std::uint64_t>(static_cast<std::int64_t>(get(row)));
            put_varint(bytes, zigzag(static_cast<std::int64_t>(value - before)));
            before = value;
        }
    }
};

template <class Row, class Get, class Has>
void read_column(VarintReader& reader, std::vector<Row>& rows, Get get, Has has) {
    std::uint64_t before = 0;
    for (Row& row : rows) {
        if (!has(row))
            continue;
        using Value = std::remove_reference_t<decltype(get(row))>;
        before += static_cast<std::uint64_t>(unzigzag(reader.next()));
        const auto value = static_cast<std::int64_t>(before);
        if (value < static_cast<std::int64_t>(std::numeric_limits<Value>::min()) ||
            value > static_cast<std::int64_t>(std::numeric_limits<Value>::max()))
            refuse("value " + std::to_string(value) + " does not fit its column, in row " +
                   std::to_string(&row - rows.data()));
        get(row) = static_cast<Value>(value);
    }
}

constexpr auto kAll = [](const auto&) { return true; };
constexpr auto kStress = [](auto& row) -> auto& {
    return row.stress_pa;
};

auto has_target(int target) {
    return [target](const StepTrace& step) { return step.targets > target; };
}

void check_targets(std::span<const StepTrace> steps) {
    for (const StepTrace& step : steps)
        if (step.targets < 0 || step.targets > kMaxTargets)
            refuse("step " + std::to_string(step.step) + " has " + std::to_string(step.targets) +
                   " targets, 0 to " + std::to_string(kMaxTargets) + " are possible");
}

std::vector<std::byte> compressed(std::span<const std::byte> raw) {
    const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                       &ZSTD_freeCCtx);
    if (!context)
        throw std::bad_alloc();
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kZstdLevel);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
    std::vector<std::byte> bytes(kMagic.begin(), kMagic.end());
    bytes.resize(kMagic.size() + ZSTD_compressBound(raw.size()));
    const std::size_t size = ZSTD_compress2(context.get(), bytes.data() + kMagic.size(),
                                            bytes.size() - kMagic.size(), raw.data(), raw.size());
    if (ZSTD_isError(size))
        throw std::runtime_error(std::string("trace: zstd: ") + ZSTD_getErrorName(size));
    bytes.resize(kMagic.size() + size);
    return bytes;
}

// All limits are checked before anything is allocated.
std::vector<std::byte> decompressed(std::span<const std::byte> bytes) {
    if (bytes.size() < kMagic.size() ||
        !std::equal(kMagic.begin(), kMagic.end() - 1, bytes.begin()))
        refuse("does not begin with TRC");
    if (bytes[3] != kMagic[3] && bytes[3] != std::byte{1})
        refuse("format " + std::to_string(std::to_integer<int>(bytes[3])) +
               ", this build reads formats 1 and 2");
    const auto frame = bytes.subspan(kMagic.size());
    const unsigned long long size = ZSTD_getFrameContentSize(frame.data(), frame.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
        refuse("damaged zstd frame header");
    if (size > kMaxRawBytes)
        refuse("claims " + std::to_string(size) + " bytes, at most " +
               std::to_string(kMaxRawBytes) + " are possible");
    if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size())
        refuse("zstd frame cut short, or bytes after it");
    std::vector<std::byte> raw(static_cast<std::size_t>(size));
    const std::size_t got = ZSTD_decompress(raw.data(), raw.size(), frame.data(), frame.size());
    if (ZSTD_isError(got))
        refuse(std::string("zstd: ") + ZSTD_getErrorName(got));
    raw.resize(got);
    return raw;
}

} // namespace

std::vector<std::byte> encode_chunk(std::span<const TickTrace> ticks,
                                    std::span<const StepTrace> steps) {
    if (ticks.size() > kMaxRows || steps.size() > kMaxRows)
        refuse("more than " + std::to_string(kMaxRows) + " ticks or steps in one chunk");
    check_targets(steps);
    ColumnWriter writer;
    put_varint(writer.bytes, ticks.size());
    put_varint(writer.bytes, steps.size());
    tick_columns([&](auto get) { writer.column(ticks, get, kAll); });
    step_columns([&](auto get) { writer.column(steps, get, kAll); });
    target_columns([&](int target, auto get) { writer.column(steps, get, has_target(target)); });
    scope_columns([&](auto get) { writer.column(ticks, get, kAll); });
    writer.column(steps, kStress, kAll);
    sight_columns([&](int target, auto get) { writer.column(steps, get, has_target(target)); });
    return compressed(writer.bytes);
}

Chunk decode_chunk(std::span<const std::byte> bytes) {
    const std::vector<std::byte> raw = decompressed(bytes);
    VarintReader reader(raw);
    const std::uint64_t ticks = reader.next();
    const std::uint64_t steps = reader.next();
    // Every value takes at least one byte, so a count that the bytes cannot fill is a lie.
    if (ticks > kMaxRows || steps > kMaxRows ||
        ticks * kTickColumns + steps * kStepColumns > reader.left())
        refuse("claims " + std::to_string(ticks) + " ticks and " + std::to_string(steps) +
               " steps in " + std::to_string(raw.size()) + " bytes");
    Chunk chunk;
    chunk.ticks.resize(static_cast<std::size_t>(ticks));
    chunk.steps.resize(static_cast<std::size_t>(steps));
    tick_columns([&](auto get) { read_column(reader, chunk.ticks, get, kAll); });
    step_columns([&](auto get) { read_column(reader, chunk.steps, get, kAll); });
    check_targets(chunk.steps);
    target_columns(
        [&](int target, auto get) { read_column(reader, chunk.steps, get, has_target(target)); });
    if (bytes[3] != std::byte{1}) {
        scope_columns([&](auto get) { read_column(reader, chunk.ticks, get, kAll); });
        read_column(reader, chunk.steps, kStress, kAll);
        sight_columns([&](int target, auto get) {
            read_column(reader, chunk.steps, get, has_target(target));
        });
    }
    if (reader.left() != 0)
        refuse(std::to_string(reader.left()) + " bytes after the last column");
    return chunk;
}

} // namespace tasks
