#include "sim/io/files.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <openssl/evp.h>
#include <stdexcept>
#include <unistd.h>

namespace sim {
namespace {

std::filesystem::path folder(const char* variable, const char* built_in) {
    const char* set = std::getenv(variable);
    return set && *set ? set : built_in;
}

} // namespace

std::vector<std::byte> read_bytes(const std::filesystem::path& path, std::size_t most) {
    std::error_code absent; // said better below
    const std::filesystem::file_status status = std::filesystem::status(path, absent);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw std::runtime_error(fmt::format("{}: is {}, not a file", path.string(),
                                             is_directory(status) ? "a directory" : "special"));
    }
    const std::uintmax_t size = std::filesystem::file_size(path, absent);
    if (!absent && size > most) {
        throw std::runtime_error(
            fmt::format("{}: has {} bytes: at most {}", path.string(), size, most));
    }
    std::ifstream in(path, std::ios::binary);
    if (!in) {
        throw std::runtime_error(
            fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    }
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

std::string read_text(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_bytes(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write_text(const std::filesystem::path& path, std::string_view text) {
    const std::filesystem::path part = path.string() + ".part";
    {
        std::ofstream out(part, std::ios::binary | std::ios::trunc);
        out.write(text.data(), static_cast<std::streamsize>(text.size()));
        out.flush();
        if (!out) {
            const std::string reason = std::strerror(errno);
            std::error_code ignored;
            std::filesystem::remove(part, ignored);
            throw std::runtime_error(
                fmt::format("{}: cannot be written: {}", path.string(), reason));
        }
    }
    std::filesystem::rename(part, path);
}

std::filesystem::path assets_dir() {
    return folder("TROCAR_ASSETS", TROCAR_ASSETS);
}

std::filesystem::path find_asset(std::string_view kind, const std::string& name_or_path) {
    if (std::filesystem::is_regular_file(name_or_path))
        return name_or_path;
    const std::filesystem::path named = assets_dir() / kind / (name_or_path + ".toml");
    if (std::filesystem::is_regular_file(named))
        return named;
    throw std::runtime_error(fmt::format("\"{}\" is neither a file nor one of the {} (tried {})",
                                         name_or_path, kind, named.string()));
}

std::filesystem::path organ_path(const std::string& file) {
    return folder("TROCAR_ORGANS", TROCAR_ORGANS) / file;
}

std::filesystem::path user_data_dir() {
    std::filesystem::path base = folder("XDG_DATA_HOME", "");
    if (base.empty())
        base = folder("HOME", "/tmp") / ".local/share";
    const std::filesystem::path dir = base / "trocar";
    std::filesystem::create_directories(dir);
    return dir;
}

std::string sha256_hex(std::span<const std::byte> bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) !=
        1) {
        throw std::runtime_error("SHA-256 is not available from libcrypto");
    }
    std::string hex;
    for (unsigned int i = 0; i < length; ++i)
        hex += fmt::format("{:02x}", digest[i]);
    return hex;
}

} // namespace sim
