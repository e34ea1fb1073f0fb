// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/files/files.hh"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/temporary_file.hh"
#include "base/text.hh"
#include "clients/screen/files/file_documents.hh"
#include "clients/screen/http/error_response.hh"
#include "clients/screen/server/descriptors.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t LONGEST_NAME = 200;

std::string reason() {
    return std::strerror(errno);
}

/// True for a path component that is not hidden and does not lead upwards.
bool isPlainName(std::string_view name) {
    return !name.empty() && name.size() <= LONGEST_NAME && name[0] != '.' &&
           name.find_first_of("/\\") == std::string_view::npos && std::ranges::none_of(name, [](char c) {
               return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
           });
}

bool write_all(int fd, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            return false;
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

/// An open file, which holds its descriptor.
class FileBody final : public BodySource {
  public:
    FileBody(int fd, std::uint64_t size) : fd_(fd), size_(size) {}
    ~FileBody() override { ::close(fd_); }
    FileBody(const FileBody &) = delete;
    FileBody &operator=(const FileBody &) = delete;

    std::uint64_t size() const override { return size_; }
    std::string read() override {
        std::string piece(std::min<std::uint64_t>(PIECE, size_ - at_), '\0');
        ssize_t got = 0;
        do {
            got = ::pread(fd_, piece.data(), piece.size(), static_cast<off_t>(at_));
        } while (got < 0 && errno == EINTR);
        piece.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        at_ += piece.size();
        return piece;
    }

  private:
    int fd_;
    std::uint64_t size_, at_ = 0;
};

constexpr std::uint64_t MOST_READ = 256ULL * 1024 * 1024;

/// A regular file, in memory if it is small. 404 with the text `missing` if there is none.
Response file_response(const std::string &path, std::string type, const std::string &missing) {
    const int fd =
        ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);  // must not wait for a pipe
    if (fd < 0) {
        return error_response(404, missing);
    }
    if (isReserved(fd)) {
        ::close(fd);
        return error_response(503, "too many files are open: ask again later");
    }
    struct stat facts{};
    const bool is_file = ::fstat(fd, &facts) == 0 && S_ISREG(facts.st_mode);
    auto source = std::make_shared<FileBody>(fd, is_file ? static_cast<std::uint64_t>(facts.st_size) : 0);
    if (!is_file) {
        return error_response(404, missing);
    }
    if (source->size() > MOST_READ) {
        return error_response(413, "the file is too large to be shown");
    }
    Response response;
    response.type = std::move(type);
    if (source->size() > BodySource::PIECE) {
        response.source = std::move(source);
    } else {
        response.body = source->read();
    }
    return response;
}

/// Name of the last replaced version of a program.
std::string former_of(const std::string &path) {
    return path + '~';
}

/// Takes ownership of the descriptor. Null if there is none or it cannot be used, see errno.
std::unique_ptr<FileBody> open_body(int fd) {
    struct stat facts{};
    if (fd < 0) {
        return nullptr;
    }
    if (::fstat(fd, &facts) != 0) {
        ::close(fd);
        return nullptr;
    }
    return std::make_unique<FileBody>(fd, static_cast<std::uint64_t>(facts.st_size));
}

/// Compares the content from the current positions on.
bool hasSameContent(BodySource &one, BodySource &other) {
    std::uint64_t same = 0;
    while (same < one.size() && one.size() == other.size()) {
        const std::string piece = one.read();
        if (piece.empty() || piece != other.read()) {
            return false;
        }
        same += piece.size();
    }
    return one.size() == other.size();
}

bool copy_to(BodySource &from, const std::string &target) {
    auto copy = TemporaryFile::create(target);
    for (std::uint64_t copied = 0; copy.has_value() && copied < from.size();) {
        const std::string piece = from.read();
        if (piece.empty() || !write_all(copy->fd(), piece)) {
            return false;
        }
        copied += piece.size();
    }
    return copy.has_value() && ::fchmod(copy->fd(), 0644) == 0 && copy->replace_target();
}

/// If `replacement` has another content, copies the file at `path` to the name of the former version,
/// replacing the previous one. Errors are in errno.
bool keep_former(const std::string &path, int replacement) {
    const auto open = [&path] { return open_body(::open(path.c_str(), O_RDONLY | O_CLOEXEC)); };
    const auto old = open();
    if (old == nullptr) {
        return errno == ENOENT;
    }
    const auto made = open_body(::dup(replacement));
    if (made != nullptr && hasSameContent(*old, *made)) {
        return true;
    }
    const auto whole = open();
    return whole != nullptr && copy_to(*whole, former_of(path));
}

Response done() {
    Response response;
    response.body = "{}";
    return response;
}

std::string type_of(const std::string &path) {
    constexpr std::array<std::pair<std::string_view, const char *>, 12> TYPES{
        {{".html", "text/html; charset=utf-8"},
         {".js", "text/javascript; charset=utf-8"},
         {".css", "text/css; charset=utf-8"},
         {".json", "application/json"},
         {".webmanifest", "application/manifest+json"},
         {".svg", "image/svg+xml"},
         {".png", "image/png"},
         {".ico", "image/x-icon"},
         {".woff2", "font/woff2"},
         {".wasm", "application/wasm"},
         {".map", "application/json"},
         {".txt", "text/plain; charset=utf-8"}}};
    const auto found =
        std::ranges::find_if(TYPES, [&](const auto &one) { return path.ends_with(one.first); });
    return found == TYPES.end() ? "application/octet-stream" : found->second;
}

}  // namespace

ProgramFiles::ProgramFiles(std::string folder, std::vector<std::string> extensions)
    : folder_(std::move(folder)), extensions_(std::move(extensions)) {
    remove_dead_temporary_files(folder_);
}

Result<std::string> ProgramFiles::path_of(const std::string &name) const {
    if (!isPlainName(name)) {
        return fail("'" + printable(name) + "' is no name of a program: without '/', not hidden, at most " +
                    std::to_string(LONGEST_NAME) + " bytes");
    }
    const std::string lower = to_lower(name);
    const bool is_program = std::ranges::any_of(extensions_, [&](const std::string &one) {
        return lower.ends_with(one) && lower.size() > one.size();
    });
    if (!is_program) {
        std::string all;
        for (const std::string &one : extensions_) {
            all += ' ' + one;
        }
        return fail("'" + printable(name) + "' is no program: their names end in one of" + all);
    }
    return folder_ + '/' + name;
}

Response ProgramFiles::list() const {
    std::error_code error;
    std::vector<FileFacts> files;
    fs::directory_iterator entry(folder_, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const auto path = path_of(name);
        struct stat facts{};
        if (path.has_value() && ::stat(path->c_str(), &facts) == 0 && S_ISREG(facts.st_mode)) {
            files.push_back({name, static_cast<std::uint64_t>(facts.st_size), facts.st_mtim.tv_sec});
        }
    }
    if (error) {
        return error_response(404, "cannot list the folder of programs '" + folder_ +
                                       "': " + error.message() + "; [DISPLAY]PROGRAM_PREFIX names it");
    }
    std::ranges::sort(files, {}, &FileFacts::name);
    Response response;
    response.body = files_document(files);
    return response;
}

Response ProgramFiles::read(const std::string &name, const std::optional<std::string> &made) const {
    auto path = path_of(name);
    if (!path.has_value()) {
        return error_response(400, path.error().str());
    }
    path = made.value_or(*path);
    return file_response(*path, "text/plain; charset=utf-8", "there is no program '" + name + "'");
}

Response ProgramFiles::read_former(const std::string &name) const {
    const auto path = path_of(name);
    if (!path.has_value()) {
        return error_response(400, path.error().str());
    }
    return file_response(former_of(*path), "text/plain; charset=utf-8",
                         "there is no former version of '" + name + "'");
}

Response ProgramFiles::begin(const std::string &name, const std::string &path, std::uint64_t size) {
    uploads_.erase(name);
    if (uploads_.size() >= MOST_UPLOADS) {  // the oldest upload is abandoned
        uploads_.erase(
            std::ranges::min_element(uploads_, {}, [](const auto &one) { return one.second.begun; }));
    }
    auto file = TemporaryFile::create(path);
    if (file.has_value() && isReserved(file->fd())) {
        file.reset();
        errno = EMFILE;
    }
    if (!file.has_value()) {
        return error_response(403, "cannot write into '" + folder_ + "': " + reason());
    }
    uploads_.emplace(name, Upload{std::move(*file), 0, size, ++begun_});
    return done();
}

Response ProgramFiles::write(const std::string &name, std::uint64_t offset, std::uint64_t size,
                             std::string_view piece) {
    const auto path = path_of(name);
    if (!path.has_value()) {
        return error_response(400, path.error().str());
    }
    if (size > MOST_BYTES || offset > size || piece.size() > size - offset) {
        return error_response(400,
                              fmt::format("{} bytes at {} are not within a file of {} bytes, which is at "
                                          "most {}",
                                          piece.size(), offset, size, MOST_BYTES));
    }
    if (offset == 0) {
        const Response begun = begin(name, *path, size);
        if (begun.status != done().status) {
            return begun;
        }
    }
    const auto found = uploads_.find(name);
    if (found == uploads_.end() || found->second.at != offset || found->second.size != size) {
        const std::uint64_t at = found == uploads_.end() ? 0 : found->second.at;
        return error_response(
            409, fmt::format("the upload of '{}' is at byte {}, not {}: begin again at 0", name, at, offset));
    }
    if (!write_all(found->second.file.fd(), piece)) {
        const std::string why = reason();
        uploads_.erase(found);
        return error_response(403, "cannot write '" + name + "': " + why);
    }
    found->second.at += piece.size();
    return found->second.at == size ? finish(name, *path) : done();
}

Response ProgramFiles::finish(const std::string &name, const std::string &path) {
    TemporaryFile file = std::move(uploads_.extract(name).mapped().file);
    struct stat old{};
    if (::stat(path.c_str(), &old) == 0 && !S_ISREG(old.st_mode)) {
        return error_response(403, "cannot write '" + name + "': a folder or device has this name");
    }
    if (!keep_former(path, file.fd())) {
        return error_response(403, "cannot keep the former version of '" + name + "': " + reason() +
                                       "; the new one is not saved");
    }
    // Removes the permission to execute the file.
    if (::fchmod(file.fd(), 0644) != 0 || !file.replace_target()) {
        return error_response(403, "cannot write '" + name + "': " + reason());
    }
    return file.sync_folder()
               ? done()
               : error_response(403, "'" + name + "' may be lost in a power failure: " + reason());
}

Response ProgramFiles::remove(const std::string &name) {
    const auto path = path_of(name);
    if (!path.has_value()) {
        return error_response(400, path.error().str());
    }
    std::error_code error;
    if (!fs::is_regular_file(*path, error)) {
        return error_response(404, "there is no program '" + name + "'");
    }
    if (::unlink(path->c_str()) != 0) {
        return error_response(403, "cannot remove '" + name + "': " + reason());
    }
    return done();
}

Response screen_file(const std::string &folder, const std::string &path) {
    constexpr std::string_view ASSETS = "/assets/";
    std::string place = folder;
    std::string_view rest = path;
    while (rest.size() > 1) {
        rest.remove_prefix(1);  // the '/'
        const std::string_view step = rest.substr(0, rest.find('/'));
        if (!isPlainName(step)) {
            return error_response(404, "there is no page '" + printable(path) + "'");
        }
        place += '/' + std::string(step);
        rest.remove_prefix(step.size());
    }
    place += path.ends_with('/') ? "/index.html" : "";
    std::error_code error;
    if (!fs::is_regular_file(place, error)) {
        return error_response(404, path == "/" ? "the screen is not installed: there is no " + place +
                                                     "; 'millwright ui --screen FOLDER' names another place"
                                               : "there is no page '" + printable(path) + "'");
    }
    Response response = file_response(place, type_of(place), "there is no page '" + printable(path) + "'");
    response.isKept = path.starts_with(ASSETS);  // their names contain a hash of their content
    return response;
}

}  // namespace mw::screen
