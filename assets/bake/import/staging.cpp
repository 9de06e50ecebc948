#include "assets/bake/import/staging.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <sys/stat.h>
#include <system_error>

namespace bake {
namespace {

namespace fs = std::filesystem;

bool import_writes(const fs::path& file) {
    const auto name = file.filename().string();
    return name == "report.json" || name == "report.txt" || file.extension() == ".png" ||
           file.extension() == ".organ";
}

void require_usable(const fs::path& out) {
    std::error_code error;
    const auto status = fs::symlink_status(out, error);
    if (!fs::exists(status)) {
        return;
    }
    if (!fs::is_directory(status)) {
        throw PathError(fmt::format("--out {}: is there and not a folder: accepted: a new folder",
                                    shown_path(out)));
    }
    bool report = false, other = false, any = false;
    fs::path foreign;
    for (const auto& entry : fs::directory_iterator(out, error)) {
        any = true;
        report = report || entry.path().filename() == "report.json";
        if (!import_writes(entry.path())) {
            other = true;
            foreign = entry.path();
        }
    }
    if (error || other || (any && !report)) {
        throw PathError(fmt::format(
            "--out {}: {}: accepted: a new folder, an empty one, or one of an earlier import",
            shown_path(out),
            error ? error.message()
            : other
                ? "holds \"" + shown_path(foreign.filename()) + "\", which import does not write"
                : "is not empty and has no report.json"));
    }
}

} // namespace

std::string shown_path(const fs::path& path) {
    std::string text;
    for (const char c : path.string()) {
        text += static_cast<unsigned char>(c) < ' ' || c == '\x7F' ? '?' : c;
    }
    return text;
}

Staging::Staging(const fs::path& out) : out_(out) {
    if (!out_.has_filename()) { // "dir/"
        out_ = out_.parent_path();
    }
    require_usable(out_);
    const fs::path parent = out_.has_parent_path() ? out_.parent_path() : fs::path(".");
    std::string pattern = (parent / ("." + out_.filename().string() + ".XXXXXX")).string();
    if (mkdtemp(pattern.data()) == nullptr) {
        throw PathError(fmt::format("--out {}: no folder can be made in {}: {}", shown_path(out_),
                                    shown_path(parent), std::strerror(errno)));
    }
    folder_ = pattern;
    const mode_t mask = umask(0); // mkdtemp's folder is for its owner only
    umask(mask);
    chmod(pattern.c_str(), 0777 & ~mask);
}

Staging::~Staging() {
    std::error_code ignored;
    if (!folder_.empty()) {
        fs::remove_all(folder_, ignored);
    }
}

void Staging::put_in_place() {
    const char *from = folder_.c_str(), *to = out_.c_str();
    if (fs::exists(out_)) {
        if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_EXCHANGE) != 0) {
            throw PathError(fmt::format("--out {}: cannot be replaced: {}", shown_path(out_),
                                        std::strerror(errno)));
        }
        return; // the old one is removed with this
    }
    if (std::rename(from, to) != 0) {
        throw PathError(
            fmt::format("--out {}: cannot be written: {}", shown_path(out_), std::strerror(errno)));
    }
    folder_.clear();
}

void write_whole(const fs::path& file, std::string_view bytes) {
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.flush();
    if (!out) {
        throw PathError(
            fmt::format("{}: cannot be written: {}", shown_path(file), std::strerror(errno)));
    }
}

} // namespace bake
