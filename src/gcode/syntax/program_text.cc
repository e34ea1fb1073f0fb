// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/program_text.hh"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/atomic_file.hh"
#include "base/text.hh"

namespace mw::gcode::detail {
namespace {

constexpr int WINDOW_LINES = 4096;
constexpr std::size_t CHUNK_BYTES = 1U << 20U;

/// A line without the newline, and the first line without a byte order mark.
std::string_view line_content(int number, std::string_view line) {
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) {
        line.remove_suffix(1);
    }
    return number == 1 ? without_byte_order_mark(line) : line;
}

}  // namespace

/// A file on disk: the start of every WINDOW_LINES-th line, and the two windows used last.
class ProgramText::Reader {
  public:
    Reader(std::string path, int fd, const struct stat &status)
        : path_(std::move(path)), fd_(fd), status_(status) {}
    ~Reader() { ::close(fd_); }
    Reader(const Reader &) = delete;
    Reader &operator=(const Reader &) = delete;

    std::uint64_t size() const { return static_cast<std::uint64_t>(status_.st_size); }
    const std::string &path() const { return path_; }
    const std::string &failure() const { return failure_; }
    std::uint64_t mark_of(int line) const {
        return marks_.empty() ? 0 : marks_[static_cast<std::size_t>((line - 1) / WINDOW_LINES)];
    }

    void begin_scan() {
        marks_.clear();
        chunk_.clear();
        taken_ = read_ = 0;
    }
    /// The next line with its newline; `begin` is its position.
    bool next(std::string_view &line, std::uint64_t begin, int number) {
        const void *newline = nullptr;
        std::size_t looked = 0;
        while (true) {
            const std::size_t left = chunk_.size() - taken_;
            newline =
                left > looked ? std::memchr(chunk_.data() + taken_ + looked, '\n', left - looked) : nullptr;
            if (newline != nullptr || !more()) {
                break;
            }
            looked = left;
        }
        const std::size_t left = chunk_.size() - taken_;
        if (left == 0) {
            return false;
        }
        const std::size_t length =
            newline == nullptr
                ? left
                : static_cast<std::size_t>(static_cast<const char *>(newline) - chunk_.data()) - taken_ + 1;
        line = {chunk_.data() + taken_, length};
        taken_ += length;
        if ((number - 1) % WINDOW_LINES == 0) {
            marks_.push_back(begin);
        }
        return true;
    }
    void end_scan() {
        chunk_ = {};
        taken_ = 0;
    }

    std::string_view line(int number) {
        const int window = (number - 1) / WINDOW_LINES;
        if (windows_[last_].number != window) {
            last_ = 1 - last_;
            if (windows_[last_].number != window && !load(window)) {
                return {};
            }
        }
        const Window &w = windows_[last_];
        const auto i = static_cast<std::size_t>((number - 1) % WINDOW_LINES);
        if (i + 1 >= w.starts.size()) {
            return {};
        }
        return line_content(number, {w.bytes.data() + w.starts[i], w.starts[i + 1] - w.starts[i]});
    }

  private:
    struct Window {
        int number = -1;
        std::string bytes;
        std::vector<std::size_t> starts;  ///< start of each line, and the end
    };

    /// Appends the next part of the file to the chunk; false at the end of the file.
    bool more() {
        chunk_.erase(0, taken_);
        taken_ = 0;
        const std::size_t had = chunk_.size();
        chunk_.resize(had + CHUNK_BYTES);
        const std::size_t got = read_at(chunk_.data() + had, CHUNK_BYTES, read_);
        chunk_.resize(had + got);
        read_ += got;
        return got > 0;
    }

    std::size_t read_at(char *to, std::size_t size, std::uint64_t place) {
        std::size_t got = 0;
        while (got < size) {
            const ssize_t n = ::pread(fd_, to + got, size - got, static_cast<off_t>(place + got));
            if (n < 0 && errno == EINTR) {
                continue;
            }
            if (n < 0) {
                failure_ = "cannot read " + path_ + ": " + std::strerror(errno);
            }
            if (n <= 0) {
                break;
            }
            got += static_cast<std::size_t>(n);
        }
        return got;
    }

    bool load(int number) {
        Window &w = windows_[last_];
        w.number = -1;
        const auto index = static_cast<std::size_t>(number);
        const std::uint64_t begin = marks_[index];
        const std::uint64_t end = index + 1 < marks_.size() ? marks_[index + 1] : size();
        w.bytes.resize(end - begin);
        struct stat now{};
        const bool same = ::fstat(fd_, &now) == 0 && now.st_size == status_.st_size &&
                          now.st_mtim.tv_sec == status_.st_mtim.tv_sec &&
                          now.st_mtim.tv_nsec == status_.st_mtim.tv_nsec;
        if (read_at(w.bytes.data(), w.bytes.size(), begin) != w.bytes.size() || !same) {
            failure_ =
                failure_.empty() ? "The file " + path_ + " was changed while it was running" : failure_;
            return false;
        }
        w.starts.clear();
        for (std::size_t at = 0; at < w.bytes.size();) {
            w.starts.push_back(at);
            const std::size_t newline = w.bytes.find('\n', at);
            at = newline == std::string::npos ? w.bytes.size() : newline + 1;
        }
        w.starts.push_back(w.bytes.size());
        w.number = number;
        return true;
    }

    std::string path_;
    int fd_;
    struct stat status_;
    std::vector<std::uint64_t> marks_;
    std::string chunk_;  ///< of the scan
    std::size_t taken_ = 0;
    std::uint64_t read_ = 0;
    std::array<Window, 2> windows_;
    std::size_t last_ = 0;
    std::string failure_;
};

ProgramText::ProgramText(std::string text) : text_(std::move(text)), size_(text_.size()) {}
ProgramText::ProgramText(std::unique_ptr<Reader> reader)
    : reader_(std::move(reader)), size_(reader_->size()) {}
ProgramText::~ProgramText() = default;
ProgramText::ProgramText(ProgramText &&) noexcept = default;
ProgramText &ProgramText::operator=(ProgramText &&) noexcept = default;

Result<ProgramText> ProgramText::open(const std::string &path) {
    const Result<int> fd = open_regular_file(path);
    if (!fd.has_value()) {
        return std::unexpected(fd.error());
    }
    struct stat status{};
    if (::fstat(*fd, &status) == 0 && static_cast<std::uint64_t>(status.st_size) >= WINDOWED_FROM_BYTES) {
        return ProgramText(std::make_unique<Reader>(path, *fd, status));
    }
    ::close(*fd);
    Result<std::string> text = read_file(path);
    if (!text) {
        return std::unexpected(text.error());
    }
    return ProgramText(std::move(*text));
}

Result<> ProgramText::hold() {
    if (isHeld()) {
        return {};
    }
    Result<std::string> text = read_file(reader_->path(), reader_->size());
    if (!text) {
        return std::unexpected(text.error());
    }
    *this = ProgramText(std::move(*text));
    return {};
}

void ProgramText::begin_scan() {
    count_ = 0;
    scanned_ = 0;
    starts_.clear();
    if (reader_ != nullptr) {
        reader_->begin_scan();
    } else {
        constexpr std::size_t SHORT_LINE = 16;  // unused capacity uses no memory
        starts_.reserve(text_.size() / SHORT_LINE + 2);
    }
}

bool ProgramText::next_of_scan(std::string_view &content) {
    if (reader_ != nullptr) {
        if (!reader_->next(content, scanned_, count_ + 1)) {
            return false;
        }
    } else {
        if (scanned_ >= text_.size()) {
            return false;
        }
        const char *const begin = text_.data() + scanned_;
        const void *const newline = std::memchr(begin, '\n', text_.size() - scanned_);
        content = {begin, newline == nullptr
                              ? text_.size() - scanned_
                              : static_cast<std::size_t>(static_cast<const char *>(newline) - begin) + 1};
        starts_.push_back(scanned_);
    }
    scanned_ += content.size();
    ++count_;
    content = line_content(count_, content);
    return true;
}

Result<bool> ProgramText::end_scan() {
    if (reader_ != nullptr) {
        reader_->end_scan();
        if (!reader_->failure().empty()) {
            return mw::fail(reader_->failure());
        }
    } else {
        starts_.push_back(text_.size());
    }
    return true;
}

std::uint64_t ProgramText::place_of(int line) const {
    if (line > count_) {
        return size_;
    }
    return reader_ != nullptr ? reader_->mark_of(line) : starts_[static_cast<std::size_t>(line - 1)];
}

std::string_view ProgramText::line(int line) const {
    if (reader_ != nullptr) {
        return reader_->line(line);
    }
    const auto i = static_cast<std::size_t>(line - 1);
    return line_content(line, {text_.data() + starts_[i], starts_[i + 1] - starts_[i]});
}

const std::string &ProgramText::failure() const {
    static const std::string NONE;
    return reader_ != nullptr ? reader_->failure() : NONE;
}

}  // namespace mw::gcode::detail
