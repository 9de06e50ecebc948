// tasks/logbook/uuid.h
// Pseudonyms of trainees: random UUIDs, so that an id tells nothing about the person. Used by the
// logbook; any thread but the 1 kHz one.
#pragma once

#include <string>
#include <string_view>

namespace tasks {

/// Version 4 (RFC 9562), 122 bits from the system's generator, lower case with hyphens. Throws
/// LogbookError if the generator fails.
std::string random_uuid();

/// True for 8-4-4-4-12 lower-case hex digits, of any version.
bool is_uuid(std::string_view text) noexcept;

} // namespace tasks
