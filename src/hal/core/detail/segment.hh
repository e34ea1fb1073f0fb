// SPDX-License-Identifier: GPL-2.0-or-later
// What lies in the HAL segment. Records refer to each other by offset, so that every process may map it
// anywhere; only pin slots hold addresses, each in the mapping of the pin's owner. All but the fields marked
// realtime is changed under the segment's lock only.
#pragma once

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/result.hh"
#include "hal/core/hal.hh"
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

/// Begins every record. The list is the truth; the hash chains are rebuilt from it when a process died in
/// between.
struct Record {
    Offset next;       ///< in the table's list, newest first; in its free list once removed
    Offset hash_next;  ///< in the bucket
    std::uint32_t hash;
    /// Of pins and signals: 8 bytes in a block of values, which stay with the record when it is used again. A
    /// component's values lie side by side: the servo thread reads and writes hundreds of them in a cycle. A
    /// pin's is in use while it is not linked. What it holds: realtime
    Offset value;
    std::array<char, NAME_LENGTH + 1> name;

    std::string_view name_view() const noexcept { return name.data(); }
};

struct CompRecord : Record {
    std::int32_t id;
    CompType type;
    bool isReady;
    bool isLoadedByLoadrt;
    bool isAskedToEnd;  ///< its end is no accident
    runtime::ProcessId process;
    std::uint64_t base;  ///< where the owner has mapped the content
    Offset insmod_args;  ///< a text
};

struct PinRecord : Record {
    Type type;
    Dir dir;
    bool hasSafeValue;
    Offset comp;
    Offset signal;
    Offset slot;  ///< the pointer that the component reads through
    Offset alias;
    std::uint64_t safe_value;
};

struct ParamRecord : Record {
    Type type;
    Dir dir;
    Offset comp;
    Offset address;  ///< of its value, in memory of the component. realtime
    Offset alias;
};

struct SignalRecord : Record {
    Type type;
    std::int32_t readers, writers, bidirectionals;
};

struct FunctRecord : Record {
    Offset comp;
    bool isReentrant;
    bool usesFloat;
    std::int32_t users;
    std::uint64_t function;  ///< addresses in the owner's process
    std::uint64_t argument;
    std::uint64_t time_slot;               ///< pin slot of .time. realtime
    alignas(8) std::int32_t tmax;          ///< realtime
    alignas(8) bool isTmaxIncreased;       ///< realtime
    std::atomic<std::uint32_t> init_runs;  ///< times it ran as an init function. realtime
};

struct ListEntry {
    std::uint64_t function;
    std::uint64_t argument;
    Offset funct;
    bool isInit;
};

struct FunctionList {
    std::uint32_t count;
    std::array<ListEntry, THREAD_FUNCTIONS> entries;
};

struct ThreadRecord : Record {
    std::int64_t period_ns;
    Offset comp;
    std::array<Offset, 2> lists;
    /// Which of the lists the thread takes next. Sequentially consistent with `cycle`: either the thread's
    /// next load sees a new list, or the one who changed it sees the thread running and waits for the cycle
    /// to end. realtime
    std::atomic<std::uint32_t> active;
    std::atomic<std::uint32_t> cycle;  ///< odd while the functions run. realtime
                                       // As last told by the host (publish_thread_figures).
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

/// A block of rtapi_shmem_*; its name is its key.
struct BlockRecord : Record {
    std::int32_t key;
    std::int32_t users;
    std::uint64_t size;
    std::uint64_t room;
    Offset memory;
};

/// The queue of a port signal, followed by `size` bytes. Positions run from 0 to size - 1 with a byte kept
/// free.
struct PortQueue {
    std::uint32_t size;
    // Released by its writer after the bytes are in place, acquired by the reader before it copies them.
    // realtime
    std::atomic<std::uint32_t> in;
    // Released by the reader after its copy, acquired by the writer before it fills the bytes anew. realtime
    std::atomic<std::uint32_t> out;
};

/// A component whose process died with it.
struct DeathRecord {
    std::array<char, NAME_LENGTH + 1> name;
    std::int32_t pid;
    std::int64_t time_ns;  ///< of the monotonic clock
};

inline constexpr std::size_t DEATHS = 16;

/// How the host came to its end, as far as it could say.
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
    pthread_mutex_t mutex;                 ///< robust and shared between processes
    std::atomic<std::uint32_t> isRunning;  ///< threads are started. realtime
    std::atomic<std::uint32_t> links;      ///< counts how often a pin was pointed at a value. realtime
    std::atomic<std::uint8_t> lock;
    bool isVirtual;
    bool isRealtime;                         ///< threads have realtime priority
    std::array<char, 512> realtime_missing;  ///< why threads have none
    std::int32_t next_comp_id;
    std::int32_t spared_pid;    ///< its components outlive it while the machine brakes; 0: none
    std::uint32_t death_count;  ///< since the start; the last DEATHS of them are kept
    std::array<DeathRecord, DEATHS> deaths;
    EndRecord end;
    Offset top;                        ///< first byte never handed out
    Offset next_value, end_of_values;  ///< what is left of the newest block of values
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

/// The segment as mapped here. All methods but lock() and at() need the lock held.
class Segment {
  public:
    Segment() = default;
    explicit Segment(runtime::SharedMemory memory) noexcept;
    /// Sets the header up; once, by the creator.
    void initialise(bool isVirtual) noexcept;

    Header &header() const noexcept { return *static_cast<Header *>(data_); }
    char *data() const noexcept { return static_cast<char *>(data_); }
    std::uint64_t base() const noexcept { return reinterpret_cast<std::uint64_t>(data_); }
    const runtime::SharedMemory &memory() const noexcept { return memory_; }

    /// Waits for the lock; repairs what a process that died with it left half done.
    void lock() noexcept;
    void unlock() noexcept;

    template <class T>
    T *at(Offset offset) const noexcept {
        return offset == 0 ? nullptr : reinterpret_cast<T *>(data() + offset);
    }
    Offset offset_of(const void *pointer) const noexcept {
        return static_cast<Offset>(static_cast<const char *>(pointer) - data());
    }
    /// True when `bytes` from `pointer` on lie in memory handed out.
    bool contains(const void *pointer, std::size_t bytes) const noexcept;

    /// Zeroed memory; 0 when none is left.
    Offset allocate(std::size_t bytes, std::size_t alignment = 8) noexcept;

    Table &table(Kind kind) const noexcept { return header().tables[static_cast<std::size_t>(kind)]; }
    Record *find(Kind kind, std::string_view name) const noexcept;
    template <class T>
    T *find_as(Kind kind, std::string_view name) const noexcept {
        return static_cast<T *>(find(kind, name));
    }
    /// A zeroed record with its name, not in the table yet; null when memory is short.
    template <class T>
    T *make(Kind kind, std::string_view name) noexcept {
        return static_cast<T *>(make_raw(kind, name, sizeof(T)));
    }
    /// The next value lies in another cache line than those before.
    void separate_values() noexcept;
    /// Puts a filled record into its table.
    void insert(Kind kind, Record &record) noexcept;
    void remove(Kind kind, Record &record) noexcept;

    /// Calls visit(T &) for every record, newest first; the visitor may remove the one it is given.
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
};

}  // namespace mw::hal::detail
