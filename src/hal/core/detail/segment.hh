// SPDX-License-Identifier: GPL-2.0-or-later
// Content of the HAL segment. Records refer to each other by offset, so that each process may map it at any
// address; only pin slots hold addresses, each in the mapping of the pin's owner. All fields except those
// marked realtime change only under the segment's lock.
#pragma once

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/result.hh"
#include "hal/core/components.hh"
#include "hal/core/value.hh"
#include "runtime/shared_memory.hh"

namespace mw::hal::detail {

using Offset = std::uint32_t;  ///< from the start of the content; 0: none

inline constexpr std::size_t BUCKETS = 1024;
inline constexpr std::size_t FIRST_SIZE = 1U << 20U;
inline constexpr std::size_t GROWTH = 1U << 20U;
inline constexpr std::size_t RESERVE = 256U << 20U;
inline constexpr std::size_t THREAD_FUNCTIONS = 1024;
inline constexpr std::size_t END_TEXT = 512;
inline constexpr std::size_t CACHE_LINE = 64;
inline constexpr std::size_t BLOCK_OF_VALUES = 4096;
inline constexpr std::uint32_t ABI_VERSION = 2;

enum class Kind : std::uint8_t {
    COMP,
    PIN,
    PARAM,
    SIGNAL,
    FUNCT,
    THREAD,
    PIN_ALIAS,
    PARAM_ALIAS,
    BLOCK,
    COUNT
};

/// Start of every record. The list is authoritative; the hash chains are rebuilt from it when a process died
/// during a change.
struct Record {
    Offset next;       ///< next record in the table's list, newest first; after removal in the free list
    Offset hash_next;  ///< next record in the same hash bucket
    std::uint32_t hash;
    /// For pins and signals: 8 bytes in a block of values, which stay with the record when it is reused. The
    /// values of a component are adjacent, because the servo thread accesses hundreds of them in a cycle. The
    /// value of a pin is used while the pin is not linked. Content: realtime
    Offset value;
    std::array<char, NAME_LENGTH + 1> name;

    std::string_view name_view() const noexcept { return name.data(); }
};

struct CompRecord : Record {
    std::int32_t id;
    CompType type;
    bool isReady;
    bool is_loaded_by_loadrt;
    bool end_requested;  ///< another process has requested its end
    runtime::ProcessId process;
    std::uint64_t base;  ///< address of the content in the owner's process
    Offset insmod_args;  ///< a text in the segment
};

struct PinRecord : Record {
    Type type;
    Dir dir;
    bool has_safe_value;
    Offset comp;
    Offset signal;
    Offset slot;  ///< the pointer through which the component accesses the value
    Offset alias;
    std::uint64_t safe_value;
};

struct ParamRecord : Record {
    Type type;
    Dir dir;
    Offset comp;
    Offset address;  ///< address of the value in memory of the component. realtime
    Offset alias;
};

struct SignalRecord : Record {
    Type type;
    std::int32_t readers, writers, bidirectionals;
};

struct FunctRecord : Record {
    Offset comp;
    bool reentrant;
    bool usesFloat;
    std::int32_t users;
    std::uint64_t function;  ///< addresses in the owner's process
    std::uint64_t argument;
    std::uint64_t time_slot;               ///< pin slot of .time. realtime
    alignas(8) std::int32_t tmax;          ///< realtime
    alignas(8) bool tmax_increased;        ///< realtime
    std::atomic<std::uint32_t> init_runs;  ///< number of runs as an init function. realtime
};

struct ListEntry {
    std::uint64_t function;
    std::uint64_t argument;
    Offset funct;
    bool is_init;
};

struct FunctionList {
    std::uint32_t count;
    std::array<ListEntry, THREAD_FUNCTIONS> entries;
};

struct ThreadRecord : Record {
    std::int64_t period_ns;
    Offset comp;
    std::array<Offset, 2> lists;
    /// Index of the list for the next cycle. Sequentially consistent with `cycle`: either the thread's next
    /// load sees the new list, or the process that changed it sees the running thread and waits for the end
    /// of the cycle. realtime
    std::atomic<std::uint32_t> active;
    std::atomic<std::uint32_t> cycle;  ///< odd while the functions run. realtime
                                       // As last published by the host (publish_thread_figures).
    std::atomic<std::uint64_t> overruns;
    std::atomic<std::int64_t> max_latency_ns;
    std::uint64_t time_slot;  ///< pin slots of .time and .threadbeat. realtime
    std::uint64_t beat_slot;
    alignas(8) std::int32_t tmax;  ///< realtime
    std::uint32_t next_timed;      ///< first function to be timed in the next period. realtime
};

struct AliasRecord : Record {
    Offset target;
};

/// A block of rtapi_shmem_*; its key is its name.
struct BlockRecord : Record {
    std::int32_t key;
    std::int32_t users;
    std::uint64_t size;
    std::uint64_t room;
    Offset memory;
};

/// A component that was removed because its process died.
struct DeathRecord {
    std::array<char, NAME_LENGTH + 1> name;
    std::int32_t pid;
    std::int64_t time_ns;  ///< monotonic clock
};

inline constexpr std::size_t DEATHS = 16;

/// Why the host ended, if it could be stored.
struct EndRecord {
    static constexpr std::uint32_t NONE = 0;
    static constexpr std::uint32_t BEING_WRITTEN = 1;
    static constexpr std::uint32_t WHOLE = 2;
    // Released as WHOLE after the text, acquired before it is read.
    std::atomic<std::uint32_t> state;
    std::array<char, END_TEXT> text;
};

struct Table {
    Offset first;
    Offset free;
    std::int32_t count;
    std::array<Offset, BUCKETS> buckets;
};

struct Header {
    pthread_mutex_t mutex;                      ///< robust and shared between processes
    std::atomic<std::uint32_t> running;         ///< threads are started. realtime
    std::atomic<std::uint32_t> links;           ///< number of changes of pin slots. realtime
    std::atomic<std::uint32_t> lost_positions;  ///< number of events; see mw_ext_lost_positions. realtime
    std::atomic<std::uint8_t> lock;
    bool is_virtual;
    bool realtime;                           ///< threads have realtime priority
    std::array<char, 512> realtime_missing;  ///< the reason why they have no realtime priority
    std::int32_t next_comp_id;
    std::int32_t spared_pid;    ///< process whose components remain while the machine brakes; 0: none
    std::uint32_t death_count;  ///< since the start; the last DEATHS of them are stored
    std::array<DeathRecord, DEATHS> deaths;
    EndRecord end;
    Offset top;                        ///< first byte that is not allocated
    Offset next_value, end_of_values;  ///< the unused part of the newest block of values
    std::array<Table, static_cast<std::size_t>(Kind::COUNT)> tables;
};

consteval std::uint64_t layout_hash() {
    std::uint64_t hash = 14695981039346656037U;
    for (const std::size_t figure :
         {sizeof(Header), offsetof(Header, tables), sizeof(CompRecord), sizeof(PinRecord),
          sizeof(ParamRecord), sizeof(SignalRecord), sizeof(FunctRecord), sizeof(ThreadRecord),
          sizeof(AliasRecord), sizeof(BlockRecord), sizeof(ListEntry), BUCKETS, THREAD_FUNCTIONS, RESERVE}) {
        hash = (hash ^ figure) * 1099511628211U;
    }
    return hash;
}

inline constexpr runtime::SharedLayout LAYOUT{ABI_VERSION, layout_hash()};

/// The segment as mapped in this process. All methods except lock() and at() need the lock.
class Segment {
  public:
    Segment() = default;
    Segment(runtime::SharedMemory memory, bool isShared) noexcept;
    /// Initialises the header; once, by the creator.
    void initialise(bool is_virtual) noexcept;

    Header &header() const noexcept { return *static_cast<Header *>(data_); }
    char *data() const noexcept { return static_cast<char *>(data_); }
    std::uint64_t base() const noexcept { return reinterpret_cast<std::uint64_t>(data_); }
    /// False when the process that created a shared segment has ended.
    bool hasHost() const noexcept;

    /// Waits for the lock; repairs changes that a dead holder left incomplete.
    void lock() noexcept;
    void unlock() noexcept;

    template <class T>
    T *at(Offset offset) const noexcept {
        return offset == 0 ? nullptr : reinterpret_cast<T *>(data() + offset);
    }
    Offset offset_of(const void *pointer) const noexcept {
        return static_cast<Offset>(static_cast<const char *>(pointer) - data());
    }
    /// True when `bytes` from `pointer` on are in allocated memory.
    bool contains(const void *pointer, std::size_t bytes) const noexcept;

    /// Zeroed memory; 0 when none is left.
    Offset allocate(std::size_t bytes, std::size_t alignment = 8) noexcept;

    Table &table(Kind kind) const noexcept { return header().tables[static_cast<std::size_t>(kind)]; }
    Record *find(Kind kind, std::string_view name) const noexcept;
    template <class T>
    T *find_as(Kind kind, std::string_view name) const noexcept {
        return static_cast<T *>(find(kind, name));
    }
    /// A zeroed record with its name, not in the table yet; null without memory.
    template <class T>
    T *make(Kind kind, std::string_view name) noexcept {
        return static_cast<T *>(make_raw(kind, name, sizeof(T)));
    }
    /// Starts a new cache line for the next value.
    void separate_values() noexcept;
    /// Inserts a filled record into its table.
    void insert(Kind kind, Record &record) noexcept;
    void remove(Kind kind, Record &record) noexcept;

    /// Calls visit(T &) for every record, newest first; the visitor may remove the current one.
    template <class T, class Visitor>
    void each(Kind kind, Visitor visit) const {
        for (Offset at_offset = table(kind).first; at_offset != 0;) {
            T *record = at<T>(at_offset);
            at_offset = record->next;
            visit(*record);
        }
    }

  private:
    Offset allocate_value() noexcept;
    Record *make_raw(Kind kind, std::string_view name, std::size_t size) noexcept;
    void unhash(Kind kind, Record &record) noexcept;
    void repair() noexcept;

    runtime::SharedMemory memory_;
    void *data_ = nullptr;
    bool isShared_ = false;
};

/// Locks a segment during its lifetime. Reading requires the lock, too.
class Guard {
  public:
    explicit Guard(Segment &segment) noexcept : segment_(segment) { segment_.lock(); }
    ~Guard() { segment_.unlock(); }
    Guard(const Guard &) = delete;
    Guard &operator=(const Guard &) = delete;

  private:
    Segment &segment_;
};

}  // namespace mw::hal::detail
