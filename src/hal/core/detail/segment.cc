// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/detail/segment.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace mw::hal::detail {
namespace {

std::uint32_t hash_of(std::string_view name) noexcept {
    std::uint32_t hash = 2166136261U;  // FNV-1a
    for (const char c : name) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
    }
    return hash;
}

}  // namespace

Segment::Segment(runtime::SharedMemory memory, bool isShared) noexcept
    : memory_(std::move(memory)), data_(memory_.data()), isShared_(isShared) {}

bool Segment::hasHost() const noexcept {
    return !isShared_ || runtime::isAlive(memory_.owner());
}

void Segment::initialise(bool is_virtual) noexcept {
    auto *fresh = new (data_) Header{};
    pthread_mutexattr_t attributes;
    ::pthread_mutexattr_init(&attributes);
    ::pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
    ::pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST);
    ::pthread_mutex_init(&fresh->mutex, &attributes);
    ::pthread_mutexattr_destroy(&attributes);
    fresh->is_virtual = is_virtual;
    // Ids are three apart, as LinuxCNC's are.
    fresh->next_comp_id = 4;
    fresh->top = static_cast<Offset>((sizeof(Header) + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE);
}

void Segment::lock() noexcept {
    if (::pthread_mutex_lock(&header().mutex) == EOWNERDEAD) {
        repair();
        ::pthread_mutex_consistent(&header().mutex);
    }
}

void Segment::unlock() noexcept {
    ::pthread_mutex_unlock(&header().mutex);
}

bool Segment::contains(const void *pointer, std::size_t bytes) const noexcept {
    const auto *at = static_cast<const char *>(pointer);
    return at >= data() + sizeof(Header) && at + bytes <= data() + header().top;
}

Offset Segment::allocate(std::size_t bytes, std::size_t alignment) noexcept {
    const std::size_t start = (header().top + alignment - 1) / alignment * alignment;
    const std::size_t end = start + std::max<std::size_t>(bytes, 1);
    if (bytes > RESERVE || end > RESERVE) {
        return 0;
    }
    if (end > memory_.size()) {
        const std::size_t wanted = std::min((end + GROWTH - 1) / GROWTH * GROWTH, memory_.reserve());
        if (!memory_.grow(wanted)) {
            return 0;
        }
    }
    header().top = static_cast<Offset>(end);
    // New pages are zero, and no part is allocated twice here.
    return static_cast<Offset>(start);
}

Offset Segment::allocate_value() noexcept {
    Header &h = header();
    if (h.next_value == h.end_of_values) {
        const Offset block = allocate(BLOCK_OF_VALUES, CACHE_LINE);
        if (block == 0) {
            return 0;
        }
        h.next_value = block;
        h.end_of_values = block + BLOCK_OF_VALUES;
    }
    const Offset value = h.next_value;
    h.next_value += sizeof(std::uint64_t);
    return value;
}

void Segment::separate_values() noexcept {
    Header &h = header();
    h.next_value = static_cast<Offset>((h.next_value + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE);
}

Record *Segment::find(Kind kind, std::string_view name) const noexcept {
    const std::uint32_t hash = hash_of(name);
    for (Offset offset = table(kind).buckets[hash % BUCKETS]; offset != 0;) {
        auto *record = at<Record>(offset);
        if (record->hash == hash && record->name_view() == name) {
            return record;
        }
        offset = record->hash_next;
    }
    return nullptr;
}

Record *Segment::make_raw(Kind kind, std::string_view name, std::size_t size) noexcept {
    Table &of = table(kind);
    const bool has_value = kind == Kind::PIN || kind == Kind::SIGNAL;
    Record *record = at<Record>(of.free);
    if (record != nullptr) {
        of.free = record->next;
        const Offset value = record->value;
        std::memset(static_cast<void *>(record), 0, size);
        record->value = value;
    } else {
        const Offset value = has_value ? allocate_value() : 0;
        record = has_value && value == 0 ? nullptr : at<Record>(allocate(size, CACHE_LINE));
        if (record == nullptr) {
            return nullptr;
        }
        record->value = value;
    }
    if (has_value) {
        *at<std::uint64_t>(record->value) = 0;
    }
    record->hash = hash_of(name);
    std::memcpy(record->name.data(), name.data(), std::min(name.size(), NAME_LENGTH));
    return record;
}

void Segment::insert(Kind kind, Record &record) noexcept {
    Table &of = table(kind);
    const Offset offset = offset_of(&record);
    record.next = of.first;
    of.first = offset;
    Offset &bucket = of.buckets[record.hash % BUCKETS];
    record.hash_next = bucket;
    bucket = offset;
    ++of.count;
}

void Segment::unhash(Kind kind, Record &record) noexcept {
    const Offset offset = offset_of(&record);
    Offset *link = &table(kind).buckets[record.hash % BUCKETS];
    while (*link != 0 && *link != offset) {
        link = &at<Record>(*link)->hash_next;
    }
    if (*link == offset) {
        *link = record.hash_next;
    }
}

void Segment::remove(Kind kind, Record &record) noexcept {
    Table &of = table(kind);
    const Offset offset = offset_of(&record);
    unhash(kind, record);
    Offset *link = &of.first;
    while (*link != 0 && *link != offset) {
        link = &at<Record>(*link)->next;
    }
    if (*link == offset) {
        *link = record.next;
        --of.count;
    }
    record.next = of.free;
    of.free = offset;
}

/// Rebuilds derived data from the lists: hash chains, counts, links of signals.
void Segment::repair() noexcept {
    for (std::size_t k = 0; k < static_cast<std::size_t>(Kind::COUNT); ++k) {
        const Kind kind = static_cast<Kind>(k);
        Table &of = table(kind);
        of.buckets.fill(0);
        of.count = 0;
        // A block that was being freed is lost, without harm.
        of.free = 0;
        each<Record>(kind, [&](Record &record) {
            Offset &bucket = of.buckets[record.hash % BUCKETS];
            record.hash_next = bucket;
            bucket = offset_of(&record);
            ++of.count;
        });
    }
    each<SignalRecord>(Kind::SIGNAL, [](SignalRecord &signal) {
        signal.readers = 0;
        signal.writers = 0;
        signal.bidirectionals = 0;
    });
    each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        auto *signal = at<SignalRecord>(pin.signal);
        if (signal != nullptr) {
            ++(pin.dir == Dir::IN    ? signal->readers
               : pin.dir == Dir::OUT ? signal->writers
                                     : signal->bidirectionals);
        }
        const auto *comp = at<CompRecord>(pin.comp);
        const Offset value = signal != nullptr ? signal->value : pin.value;
        if (comp != nullptr && pin.slot != 0) {
            __atomic_store_n(at<std::uint64_t>(pin.slot), comp->base + value, __ATOMIC_RELEASE);
        }
        pin.alias = 0;
    });
    each<ParamRecord>(Kind::PARAM, [](ParamRecord &param) { param.alias = 0; });
    each<AliasRecord>(Kind::PIN_ALIAS,
                      [&](AliasRecord &alias) { at<PinRecord>(alias.target)->alias = offset_of(&alias); });
    each<AliasRecord>(Kind::PARAM_ALIAS,
                      [&](AliasRecord &alias) { at<ParamRecord>(alias.target)->alias = offset_of(&alias); });
    // Functions of a partly removed component: the lists still contain them, until reaping removes them.
}

}  // namespace mw::hal::detail
