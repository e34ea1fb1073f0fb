// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/confinement.hh"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.hh"

namespace mw::task {
namespace {

namespace fs = std::filesystem;

/// Extensions of log files, which all programs of this computer treat as text.
constexpr std::array<std::string_view, 6> LOG_EXTENSIONS{".txt", ".log", ".csv", ".dat", ".xyz", ".asc"};

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor &&other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor &operator=(Descriptor &&other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Descriptor() {
        if (fd_ >= 0) {
            ::close(fd_);
        }
    }
    int get() const { return fd_; }
    int release() { return std::exchange(fd_, -1); }

  private:
    int fd_;
};

/// The path below `folder`, or nothing. Links in both are resolved; paths that do not exist are used
/// unchanged.
std::optional<fs::path> below(const std::string &folder, const fs::path &path) {
    std::error_code error;
    const fs::path root = fs::weakly_canonical(folder, error);
    const fs::path whole = error ? fs::path() : fs::weakly_canonical(path, error);
    if (error || root.empty() || root == root.root_path()) {
        return std::nullopt;
    }
    const auto [root_end, rest] = std::mismatch(root.begin(), root.end(), whole.begin(), whole.end());
    if (root_end != root.end() || rest == whole.end()) {
        return std::nullopt;
    }
    fs::path relative;
    for (auto part = rest; part != whole.end(); ++part) {
        relative /= *part;
    }
    return relative;
}

bool isPlain(const fs::path &relative) {
    return std::none_of(relative.begin(), relative.end(),
                        [](const fs::path &part) { return part.empty() || part.native().front() == '.'; });
}

std::unexpected<Error> refused(const std::string &path, const std::string &why) {
    return fail(fmt::format("Role operate cannot write '{}': {}.", path, why), {path, 0, 0},
                "Run the program at the machine, or as a client of role configure.");
}

bool isSameFile(const struct stat &status, const std::string &path) {
    struct stat other{};
    return ::stat(path.c_str(), &other) == 0 && other.st_dev == status.st_dev &&
           other.st_ino == status.st_ino;
}

/// Reason why an open file is not a log that a program may write; empty if it is.
std::string fault_of(const struct stat &status, const Confinement &confinement) {
    constexpr mode_t PROGRAM_BITS = S_IXUSR | S_IXGRP | S_IXOTH;
    if (!S_ISREG(status.st_mode)) {
        return "it is not a file";
    }
    if (status.st_nlink > 1 || (status.st_mode & PROGRAM_BITS) != 0) {
        return "it is executable, or has a second hard link";
    }
    const bool kept = std::ranges::any_of(confinement.kept_files,
                                          [&](const std::string &path) { return isSameFile(status, path); });
    return kept ? "it is a file of the machine" : "";
}

/// Opens `relative` below `folder` component by component: none may be a link.
Descriptor open_below(const std::string &folder, const fs::path &relative, int flags) {
    constexpr mode_t MODE = 0666;
    constexpr int STEP = O_PATH | O_DIRECTORY | O_CLOEXEC;
    Descriptor at(::open(folder.c_str(), STEP));
    for (auto part = relative.begin(); at.get() >= 0 && part != relative.end(); ++part) {
        const bool last = std::next(part) == relative.end();
        const int how = last ? flags | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC : STEP | O_NOFOLLOW;
        at = Descriptor(::openat(at.get(), part->c_str(), how, MODE));
    }
    return at;
}

}  // namespace

Result<> check_program(const Confinement &confinement, const std::string &path) {
    for (const std::string &folder : confinement.program_folders) {
        const auto relative = below(folder, path);
        if (relative.has_value() && isPlain(*relative)) {
            return {};
        }
    }
    const std::string folder =
        confinement.program_folders.empty() ? std::string() : confinement.program_folders.front();
    return fail(
        fmt::format("Role operate cannot open '{}': it is not in the program folder '{}'.", path, folder), {},
        "Copy the program into the program folder, or open it at the machine.");
}

Result<int> open_log(const Confinement &confinement, const std::string &path, bool appending) {
    if (confinement.program_folders.empty()) {
        return refused(path, "the machine has no program folder");
    }
    const std::string &folder = confinement.program_folders.front();
    const auto relative = below(folder, fs::path(folder) / path);
    if (!relative.has_value() || !isPlain(*relative)) {
        return refused(path, fmt::format("logs are written into the program folder '{}'", folder));
    }
    const std::string extension = to_lower(relative->extension().string());
    const bool is_log = std::ranges::find(LOG_EXTENSIONS, extension) != LOG_EXTENSIONS.end();
    const bool is_program =
        std::ranges::find(confinement.program_extensions, extension) != confinement.program_extensions.end();
    if (!is_log || is_program) {
        return refused(path,
                       fmt::format("the name of a log ends in one of {}", fmt::join(LOG_EXTENSIONS, " ")));
    }
    std::error_code error;
    const std::string root = fs::weakly_canonical(folder, error).string();
    Descriptor file = open_below(root, *relative, O_WRONLY | O_CREAT | (appending ? O_APPEND : 0));
    struct stat status{};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0) {
        return refused(path, errno == ELOOP ? "it is a link" : std::strerror(errno));
    }
    const std::string fault = fault_of(status, confinement);
    if (!fault.empty()) {
        return refused(path, fault);
    }
    // truncated only now, so that a rejected file is not changed
    if (!appending && ::ftruncate(file.get(), 0) != 0) {
        return refused(path, std::strerror(errno));
    }
    return file.release();
}

}  // namespace mw::task
