// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/ethernet/cycle_record_file.hh"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

namespace fs = std::filesystem;

constexpr const char *FOLDER = "/dev/shm";

std::string name_begin() {
    return fmt::format("millwright-cycles.{}.", ::getuid());
}

std::unexpected<Error> failed(const std::string &path, const char *what) {
    return fail(fmt::format("cannot {} {}: {}", what, path, std::strerror(errno)));
}

class File {
  public:
    explicit File(int descriptor) : descriptor_(descriptor) {}
    File(const File &) = delete;
    File &operator=(const File &) = delete;
    ~File() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
    }
    int get() const { return descriptor_; }

  private:
    int descriptor_;
};

template <std::size_t N>
void copy_text(std::array<char, N> &to, const std::string &text) {
    text.copy(to.data(), N - 1);
}

template <std::size_t N>
std::string text_of(const std::array<char, N> &from) {
    return {from.data(), ::strnlen(from.data(), N)};
}

/// Cycles of a ring, oldest first, without those that the writer may have changed during the copy.
std::vector<CycleTimes> copy(const CycleRing &ring, bool growing) {
    const std::uint64_t before = ring.count();
    std::vector<CycleTimes> cycles;
    const std::size_t size = ring.size();
    for (std::size_t age = size; age-- > 0;) {
        cycles.push_back(ring.at(age));
    }
    const std::uint64_t written = ring.count() - before + (growing ? 1 : 0);
    const auto lost = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(written, cycles.size()));
    if (size == CycleRing::SIZE) {
        cycles.erase(cycles.begin(), cycles.begin() + lost);
    }
    if (growing && !cycles.empty()) {
        cycles.pop_back();  // the writer has not finished this record
    }
    return cycles;
}

}  // namespace

void CycleRecordFile::Unmap::operator()(CycleRecord *record) const noexcept {
    ::munmap(record, sizeof *record);
}

Result<CycleRecordFile> CycleRecordFile::create(const std::string &board, const std::string &address) {
    const std::string path = fmt::format("{}/{}{}", FOLDER, name_begin(), board);
    ::unlink(path.c_str());
    const File file(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (file.get() < 0) {
        return failed(path, "create");
    }
    if (const int error = ::posix_fallocate(file.get(), 0, sizeof(CycleRecord)); error != 0) {
        errno = error;
        return failed(path, "reserve memory for");
    }
    void *const memory =
        ::mmap(nullptr, sizeof(CycleRecord), PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
    if (memory == MAP_FAILED) {
        return failed(path, "map");
    }
    auto *const record = new (memory) CycleRecord();
    copy_text(record->board, board);
    copy_text(record->address, address);
    return CycleRecordFile(record);
}

std::vector<std::string> find_cycle_records() {
    std::vector<std::string> paths;
    std::error_code error;
    for (const auto &entry : fs::directory_iterator(FOLDER, error)) {
        if (entry.path().filename().string().starts_with(name_begin())) {
            paths.push_back(entry.path().string());
        }
    }
    std::ranges::sort(paths);
    return paths;
}

Result<RecordedCycles> read_cycle_record(const std::string &path) {
    const File file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
    struct stat status{};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0) {
        return failed(path, "open");
    }
    if (static_cast<std::size_t>(status.st_size) != sizeof(CycleRecord) || status.st_uid != ::getuid()) {
        return fail(fmt::format("{} is no record of cycles of this program and user", path));
    }
    void *const memory = ::mmap(nullptr, sizeof(CycleRecord), PROT_READ, MAP_SHARED, file.get(), 0);
    if (memory == MAP_FAILED) {
        return failed(path, "map");
    }
    const auto unmap = [](const CycleRecord *mapped) {
        ::munmap(const_cast<CycleRecord *>(mapped), sizeof *mapped);
    };
    const std::unique_ptr<const CycleRecord, decltype(unmap)> record(static_cast<const CycleRecord *>(memory),
                                                                     unmap);
    if (record->magic != CycleRecord::MAGIC || record->layout != CycleRecord::LAYOUT) {
        return fail(fmt::format("{} is a record of cycles of another version", path));
    }
    RecordedCycles cycles;
    cycles.board = text_of(record->board);
    cycles.address = text_of(record->address);
    const std::uint32_t current = record->current.load(std::memory_order_acquire) & 1U;
    cycles.period_ns = record->period_ns.load(std::memory_order_relaxed);
    cycles.fault = record->fault.load(std::memory_order_relaxed);
    cycles.fault_ns = record->fault_ns.load(std::memory_order_relaxed);
    if (cycles.fault != BoardFault::NONE) {
        cycles.at_fault = copy(record->rings[1 - current], false);
    }
    cycles.since = copy(record->rings[current], true);
    return cycles;
}

}  // namespace mw::mesa
