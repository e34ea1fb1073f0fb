// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/data_log.hh"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"

namespace mw::publish {
namespace {

constexpr std::string_view BEGINNING = "data-", END = ".log";
constexpr std::size_t MOST_RECORD_BYTES = 1UL << 24U;

/// Header of each record in a file.
struct Head {
    std::uint32_t size = 0;
    std::uint32_t checksum = 0;
    RecordId id = 0;
};

std::uint32_t checksum_of(RecordId id, std::string_view bytes) {
    boost::crc_32_type crc;
    crc.process_bytes(&id, sizeof id);
    crc.process_bytes(bytes.data(), bytes.size());
    return crc.checksum();
}

std::string name_of(RecordId first) {
    return fmt::format("{}{:020}{}", BEGINNING, first, END);
}

/// Content of the file of confirmed records.
struct Mark {
    RecordId id = 0;
    std::uint32_t checksum = 0;
    std::uint32_t unused = 0;
};

std::string reason() {
    return std::strerror(errno);
}

}  // namespace

DataLog::DataLog(DataLog &&other) noexcept
    : folder_(std::move(other.folder_)), limits_(other.limits_), lock_(std::exchange(other.lock_, -1)),
      file_(std::exchange(other.file_, -1)), confirmed_file_(std::exchange(other.confirmed_file_, -1)),
      segments_(std::move(other.segments_)), memory_(std::move(other.memory_)), next_(other.next_),
      confirmed_(other.confirmed_), dropped_(other.dropped_), damaged_(other.damaged_), bytes_(other.bytes_),
      isUnsynced_(other.isUnsynced_), trouble_(std::move(other.trouble_)) {}

DataLog &DataLog::operator=(DataLog &&other) noexcept {
    if (this != &other) {
        close();
        std::destroy_at(this);
        std::construct_at(this, std::move(other));
    }
    return *this;
}

DataLog::~DataLog() {
    close();
}

void DataLog::close() {
    for (int *fd : {&file_, &confirmed_file_, &lock_}) {
        if (*fd >= 0) {
            ::close(std::exchange(*fd, -1));
        }
    }
}

Result<DataLog> DataLog::open(const std::string &folder, const LogLimits &limits) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        return fail(fmt::format("cannot create the folder {}: {}", folder, error.message()));
    }
    const int lock = ::open((folder + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock < 0) {
        return fail(fmt::format("cannot open {}/lock: {}", folder, reason()));
    }
    DataLog log(folder, limits, lock);
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
        return fail(fmt::format("another publisher uses {}", folder), {},
                    "end it, or set another folder as [PUBLISH]STORE");
    }
    auto loaded = log.load();
    if (!loaded.has_value()) {
        return std::unexpected(loaded.error());
    }
    return log;
}

Result<> DataLog::load() {
    std::map<RecordId, std::string> found;
    std::error_code error;
    for (const auto &entry : std::filesystem::directory_iterator(folder_, error)) {
        const std::string name = entry.path().filename();
        if (name.starts_with(BEGINNING) && name.ends_with(END)) {
            std::string_view digits(name);
            digits.remove_prefix(BEGINNING.size());
            digits.remove_suffix(END.size());
            digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
            if (const auto first = parse_uint(digits); first.has_value()) {
                found[*first] = entry.path();
            }
        }
    }
    if (error) {
        return fail(fmt::format("cannot read the folder {}: {}", folder_, error.message()));
    }
    for (const auto &[first, path] : found) {
        if (auto loaded = load_segment(path, first); !loaded.has_value()) {
            return loaded;
        }
    }
    load_confirmed();
    if (confirmed_file_ < 0) {
        return fail(fmt::format("cannot open {}/confirmed: {}", folder_, reason()));
    }
    return {};
}

Result<> DataLog::load_segment(const std::string &path, RecordId first) {
    const auto text = read_file(path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    Segment segment{path, first, {}, 0};
    while (segment.bytes + sizeof(Head) <= text->size()) {
        Head head;
        std::memcpy(&head, text->data() + segment.bytes, sizeof head);
        const std::size_t start = segment.bytes + sizeof head;
        const bool isWhole = head.size <= text->size() - start && head.id == first + segment.starts.size();
        if (!isWhole ||
            checksum_of(head.id, std::string_view(*text).substr(start, head.size)) != head.checksum) {
            ++damaged_;
            break;
        }
        segment.starts.push_back(static_cast<std::uint32_t>(segment.bytes));
        segment.bytes = start + head.size;
    }
    if (segment.starts.empty()) {
        ::unlink(path.c_str());
        return {};
    }
    // Nothing is appended to an older file, so a torn end remains after the valid records.
    next_ = std::max<RecordId>(next_, first + segment.starts.size());
    bytes_ += segment.bytes;
    segments_.push_back(std::move(segment));
    return {};
}

void DataLog::load_confirmed() {
    confirmed_file_ = ::open((folder_ + "/confirmed").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    Mark mark;
    const bool isRead = confirmed_file_ >= 0 &&
                        ::pread(confirmed_file_, &mark, sizeof mark, 0) == static_cast<ssize_t>(sizeof mark);
    if (isRead && mark.checksum == checksum_of(mark.id, "")) {
        confirmed_ = mark.id;
    } else {
        confirmed_ = segments_.empty() ? next_ : segments_.front().first;
    }
    next_ = std::max(next_, confirmed_);
    while (segments_.size() > 1 && segments_[1].first <= confirmed_) {
        drop_front();
    }
}

bool DataLog::begin_segment(RecordId first) {
    if (file_ >= 0) {
        ::close(std::exchange(file_, -1));
        if (segments_.back().starts.empty()) {  // the file has no record because the disk was full
            ::unlink(segments_.back().path.c_str());
            segments_.pop_back();
        }
    }
    const std::string path = folder_ + '/' + name_of(first);
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file_ < 0) {
        trouble_ = fmt::format("cannot write {}: {}", path, reason());
        return false;
    }
    segments_.push_back({path, first, {}, 0});
    return true;
}

bool DataLog::write(const Record &record) {
    const bool isFull = file_ >= 0 && segments_.back().bytes >= limits_.segment_bytes;
    const bool follows = file_ >= 0 && segments_.back().first + segments_.back().starts.size() == record.id;
    if ((file_ < 0 || isFull || !follows) && !begin_segment(record.id)) {
        return false;
    }
    Segment &segment = segments_.back();
    const Head head{static_cast<std::uint32_t>(record.bytes.size()), checksum_of(record.id, record.bytes),
                    record.id};
    std::string bytes(sizeof head, '\0');
    std::memcpy(bytes.data(), &head, sizeof head);
    bytes += record.bytes;
    const ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(segment.bytes));
    if (written != static_cast<ssize_t>(bytes.size())) {
        trouble_ =
            fmt::format("cannot write {}: {}", segment.path, written < 0 ? reason() : "the disk is full");
        static_cast<void>(::ftruncate(file_, static_cast<off_t>(segment.bytes)));
        return false;
    }
    segment.starts.push_back(static_cast<std::uint32_t>(segment.bytes));
    segment.bytes += bytes.size();
    bytes_ += bytes.size();
    isUnsynced_ = true;
    trouble_.clear();
    return true;
}

RecordId DataLog::append(std::string bytes) {
    bytes.resize(std::min(bytes.size(), MOST_RECORD_BYTES));
    Record record{next_++, std::move(bytes)};
    static_cast<void>(write(record));
    memory_.push_back(std::move(record));
    if (memory_.size() > MOST_IN_MEMORY) {
        memory_.pop_front();
    }
    drop_old();
    return next_ - 1;
}

void DataLog::drop_front() {
    const Segment &oldest = segments_.front();
    ::unlink(oldest.path.c_str());
    bytes_ -= oldest.bytes;
    segments_.pop_front();
}

void DataLog::drop_old() {
    while (segments_.size() > 1 && bytes_ > limits_.bytes) {
        const RecordId end = segments_[1].first;
        if (end > confirmed_) {
            dropped_ += end - confirmed_;
            confirm(end);
        } else {
            drop_front();
        }
    }
}

const Record *DataLog::in_memory(RecordId id) const {
    if (memory_.empty() || id < memory_.front().id || id > memory_.back().id) {
        return nullptr;
    }
    return &memory_[id - memory_.front().id];
}

std::string DataLog::from_disk(RecordId id) const {
    const auto segment = std::ranges::find_if(segments_, [id](const Segment &one) {
        return id >= one.first && id < one.first + one.starts.size();
    });
    if (segment == segments_.end()) {
        return {};
    }
    const int fd = ::open(segment->path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return {};
    }
    const auto start = static_cast<off_t>(segment->starts[id - segment->first]);
    Head head;
    std::string bytes;
    if (::pread(fd, &head, sizeof head, start) == static_cast<ssize_t>(sizeof head) && head.id == id &&
        head.size <= MOST_RECORD_BYTES) {
        bytes.resize(head.size);
        const ssize_t size = ::pread(fd, bytes.data(), bytes.size(), start + static_cast<off_t>(sizeof head));
        const bool isRead =
            size == static_cast<ssize_t>(head.size) && checksum_of(id, bytes) == head.checksum;
        bytes.resize(isRead ? bytes.size() : 0);
    }
    ::close(fd);
    return bytes;
}

std::string DataLog::newest() const {
    const Record *const kept = in_memory(next_ - 1);
    return kept != nullptr ? kept->bytes : from_disk(next_ - 1);
}

std::vector<Record> DataLog::read(RecordId from, std::size_t most) const {
    std::vector<Record> found;
    for (RecordId id = std::max(from, confirmed_); id < next_ && found.size() < most; ++id) {
        const Record *const kept = in_memory(id);
        found.push_back(kept != nullptr ? *kept : Record{id, from_disk(id)});
    }
    return found;
}

void DataLog::confirm(RecordId end) {
    if (end <= confirmed_ || end > next_) {
        return;
    }
    confirmed_ = end;
    const Mark mark{end, checksum_of(end, ""), 0};
    if (::pwrite(confirmed_file_, &mark, sizeof mark, 0) != static_cast<ssize_t>(sizeof mark)) {
        trouble_ = fmt::format("cannot write {}/confirmed: {}", folder_, reason());
    }
    // The newest file is kept, because the next record belongs to it.
    while (segments_.size() > 1 && segments_[1].first <= confirmed_) {
        drop_front();
    }
}

void DataLog::sync() {
    if (file_ >= 0 && std::exchange(isUnsynced_, false)) {
        ::fdatasync(file_);
    }
}

}  // namespace mw::publish
