// sim/io/files.h
// The files that sim/ opens: assets by name, texts and bytes whole, outputs written beside and
// then renamed, so that nothing half-written is ever seen.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// Throws std::runtime_error naming the path and the system's reason, also for anything but a
/// regular file and for one larger than `most` bytes.
std::vector<std::byte> read_bytes(const std::filesystem::path& path,
                                  std::size_t most = std::size_t{1} << 30);
std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, std::string_view text);

/// The source tree's assets, or $TROCAR_ASSETS.
std::filesystem::path assets_dir();

/// assets/KIND/NAME.toml, or `name_or_path` itself if it is a file. Throws naming both
/// places that were tried.
std::filesystem::path find_asset(std::string_view kind, const std::string& name_or_path);

/// Baked organs: the build's organ folder, or $TROCAR_ORGANS.
std::filesystem::path organ_path(const std::string& file);

/// The user's data directory for Trocar, created if missing.
std::filesystem::path user_data_dir();

std::string sha256_hex(std::span<const std::byte> bytes);

} // namespace sim
