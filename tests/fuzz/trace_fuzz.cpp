// tests/fuzz/trace_fuzz.cpp
// libFuzzer on the trace decoder (clang only): the bytes as a chunk, and the bytes as the payload
// of a chunk, so that the fuzzer need not guess a checksum. Refusing is fine; a crash, a leak or a
// chunk that does not survive another round is a finding.
// Built and run by tests/fuzz/run.
#include "tasks/logbook/trace.h"

#include <cstdlib>
#include <stdexcept>
#include <zstd.h>

namespace {

void decode(std::span<const std::byte> bytes) {
    tasks::Chunk chunk;
    try {
        chunk = tasks::decode_chunk(bytes);
    } catch (const std::invalid_argument&) {
        return;
    }
    const auto once = tasks::encode_chunk(chunk.ticks, chunk.steps);
    const tasks::Chunk again = tasks::decode_chunk(once);
    if (tasks::encode_chunk(again.ticks, again.steps) != once)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    decode(bytes);
    for (const int format : {1, 2}) {
        std::vector<std::byte> chunk{std::byte{'T'}, std::byte{'R'}, std::byte{'C'},
                                     static_cast<std::byte>(format)};
        chunk.resize(4 + ZSTD_compressBound(size));
        chunk.resize(4 + ZSTD_compress(chunk.data() + 4, chunk.size() - 4, data, size, 1));
        decode(chunk);
    }
    return 0;
}
