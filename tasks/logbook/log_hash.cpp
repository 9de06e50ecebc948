// tasks/logbook/log_hash.cpp
// The canonical bytes of an attempt and their SHA-256; the layout is written down at LogHash in
// logbook.h. Called by the session that records, by replay and by re-score.
#include "tasks/logbook/logbook.h"

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <openssl/evp.h>

namespace tasks {
namespace {

// Little-endian fields, one record after the other.
class Record {
  public:
    template <std::integral T> Record& integer(T value) {
        auto bits = static_cast<std::make_unsigned_t<T>>(value);
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            bytes_.push_back(static_cast<unsigned char>(bits & 0xff));
            bits = static_cast<decltype(bits)>(bits >> 8);
        }
        return *this;
    }
    Record& flag(bool value) { return integer(static_cast<std::uint8_t>(value)); }
    Record& number(double value) {
        constexpr std::uint64_t kNan = 0x7ff8000000000000U;
        // value + 0.0 turns -0 into +0
        return integer(std::isnan(value) ? kNan : std::bit_cast<std::uint64_t>(value + 0.0));
    }
    Record& text(std::string_view value) {
        integer(static_cast<std::uint64_t>(value.size()));
        bytes_.insert(bytes_.end(), value.begin(), value.end());
        return *this;
    }
    const std::vector<unsigned char>& bytes() const { return bytes_; }

  private:
    std::vector<unsigned char> bytes_;
};

using Digest = std::array<unsigned char, 32>;

class Sha256 {
  public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        check(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
    }
    void add(std::span<const unsigned char> bytes) {
        check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
    }
    // Of the bytes so far; more may follow.
    Digest digest() const {
        Sha256 copy;
        Digest result{};
        check(EVP_MD_CTX_copy_ex(copy.context_.get(), context_.get()) == 1);
        check(EVP_DigestFinal_ex(copy.context_.get(), result.data(), nullptr) == 1);
        return result;
    }

  private:
    static void check(bool good) {
        if (!good)
            throw LogbookError("log hash: OpenSSL's SHA-256 failed");
    }
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

constexpr std::uint8_t kHashedToolFlags = 2 | 4; // present, faulted: inputs; the rest are results
constexpr std::uint8_t kScopePresent = 2;
constexpr std::uint8_t kHashedStepFlags = 1; // warped tangent used: schedule

} // namespace

struct LogHash::Impl {
    Sha256 setup, ticks, steps, events, metrics;
};

LogHash::LogHash() : impl_(std::make_unique<Impl>()) {}
LogHash::~LogHash() = default;

void LogHash::add_setup(const AttemptRow& attempt) {
    Record record;
    record.text(attempt.exercise).text(attempt.exercise_text);
    record.text(attempt.scene_text).text(attempt.scene_hash);
    record.text(attempt.model).text(attempt.coupling);
    record.integer(attempt.seed).integer(static_cast<std::int32_t>(attempt.fem_hz));
    record.flag(attempt.forces_on);
    record.integer(static_cast<std::uint64_t>(attempt.start_counts.size()));
    for (const auto& counts : attempt.start_counts)
        for (const std::int64_t count : counts)
            record.integer(count);
    impl_->setup.add(record.bytes());
}

void LogHash::add(const TickTrace& tick) {
    Record record;
    record.integer(tick.tick).integer(tick.adopted_step);
    for (const ToolTrace& tool : tick.tool) {
        for (const std::int32_t count : tool.counts)
            record.integer(count);
        record.integer(tool.roll_counts).integer(tool.jaw_counts);
        record.integer(static_cast<std::uint8_t>(tool.flags & kHashedToolFlags));
    }
    if (tick.scope.flags & kScopePresent) { // attempts of before keep the hash that they had
        for (const std::int32_t count : tick.scope.counts)
            record.integer(count);
        record.integer(tick.scope.camera_counts).integer(tick.scope.optic_counts);
        record.integer(tick.scope.flags);
    }
    impl_->ticks.add(record.bytes());
}

void LogHash::add(const StepTrace& step) {
    Record record;
    record.integer(step.step).integer(step.sample_tick);
    record.integer(static_cast<std::uint8_t>(step.flags & kHashedStepFlags));
    impl_->steps.add(record.bytes());
}

void LogHash::add(const Event& event) {
    Record record;
    record.integer(event.tick).integer(static_cast<std::uint8_t>(event.kind));
    record.integer(event.tool).integer(event.target);
    record.number(event.place_m.x).number(event.place_m.y).number(event.place_m.z);
    record.number(event.value);
    impl_->events.add(record.bytes());
}

void LogHash::add(const Metric& metric) {
    Record record;
    record.text(metric.id).integer(static_cast<std::int32_t>(metric.version));
    record.number(metric.value).text(metric.unit);
    record.flag(metric.lower_is_better).flag(metric.felt);
    record.integer(metric.first_tick).integer(metric.last_tick);
    impl_->metrics.add(record.bytes());
}

std::string LogHash::finish() {
    Sha256 whole;
    constexpr std::string_view kFormat = "trocar log 1\n";
    whole.add({reinterpret_cast<const unsigned char*>(kFormat.data()), kFormat.size()});
    for (const Sha256* part :
         {&impl_->setup, &impl_->ticks, &impl_->steps, &impl_->events, &impl_->metrics})
        whole.add(part->digest());
    std::string text;
    for (const unsigned char byte : whole.digest())
        text += fmt::format("{:02x}", byte);
    return text;
}

} // namespace tasks
