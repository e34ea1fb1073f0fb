// SPDX-License-Identifier: GPL-2.0-or-later
// hal_stream_*: records through a ring in a shared block, one writer and one reader.
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "hal/capi/status.hh"

using namespace mw::hal;
using namespace mw::hal::capi;
using mw::Error;

namespace {

constexpr std::uint32_t STREAM_MAGIC = 0x4d577374;
constexpr unsigned MOST_RECORDS = 1U << 20U;

}  // namespace

/// Followed by `slots` records: sample number, then a value per field. Positions are 0 to slots - 1. One slot
/// stays free, so equal positions mean empty.
struct hal_stream_fifo {
    std::uint32_t magic;
    std::int32_t creator;
    std::uint32_t depth;  // as requested by the caller
    std::uint32_t slots;  // the depth, at least 2
    std::uint32_t fields;
    std::uint8_t types[HAL_STREAM_MAX_PINS];
    // Written by the writer: `in` is released after the record is filled, and acquired by the reader before
    // it reads it.
    alignas(64) std::atomic<std::uint32_t> in;
    std::uint32_t sample;
    std::atomic<std::uint32_t> overruns;
    // Written by the reader: `out` is released after the record has been copied, and acquired by the writer
    // before it fills the slot again.
    alignas(64) std::atomic<std::uint32_t> out;
    std::atomic<std::uint32_t> underruns;
    alignas(64) hal_stream_data_u data[1];
};

namespace {

std::size_t fifo_size(unsigned slots, unsigned fields) {
    return sizeof(hal_stream_fifo) + sizeof(hal_stream_data_u) * slots * (fields + 1);
}

hal_stream_data_u *record_of(hal_stream_fifo &fifo, std::uint32_t position) noexcept {
    return fifo.data + static_cast<std::size_t>(position) * (fifo.fields + 1);
}

/// Parses the field types of a typestring; returns their number, or -EINVAL.
int parse_types(const char *typestring, std::uint8_t *types) {
    int count = 0;
    for (const char *at = typestring; *at != '\0'; ++at, ++count) {
        const char lower = static_cast<char>(*at | 0x20);
        const int type = lower == 'b'   ? HAL_BIT
                         : lower == 'f' ? HAL_FLOAT
                         : lower == 's' ? HAL_S32
                         : lower == 'u' ? HAL_U32
                         : lower == 'l' ? HAL_S64
                         : lower == 'k' ? HAL_U64
                                        : 0;
        if (type == 0 || count == HAL_STREAM_MAX_PINS) {
            return complain(
                Error{fmt::format("stream '{}': at most {} of the letters b f s u l k are allowed",
                                  typestring, HAL_STREAM_MAX_PINS)});
        }
        types[count] = static_cast<std::uint8_t>(type);
    }
    return count > 0 ? count : complain(EINVAL, "a stream needs at least one field");
}

hal_stream_fifo *open_fifo(hal_stream_t *stream, int comp, int key, std::size_t size) {
    stream->comp_id = comp;
    stream->fifo = nullptr;
    stream->shmem_id = rtapi_shmem_new(key, comp, size);
    void *memory = nullptr;
    if (stream->shmem_id > 0 && rtapi_shmem_getptr(stream->shmem_id, &memory) == 0) {
        stream->fifo = static_cast<hal_stream_fifo *>(memory);
    }
    return stream->fifo;
}

int close_fifo(hal_stream_t *stream) {
    stream->fifo = nullptr;
    return rtapi_shmem_delete(stream->shmem_id, stream->comp_id);
}

void nap() noexcept {
    const timespec time{0, 1'000'000};
    ::nanosleep(&time, nullptr);
}

}  // namespace

extern "C" {

int hal_stream_create(hal_stream_t *stream, int comp, int key, unsigned depth, const char *typestring) {
    std::uint8_t types[HAL_STREAM_MAX_PINS] = {};
    const int fields = parse_types(typestring, types);
    if (fields < 0) {
        return fields;
    }
    if (depth < 1 || depth > MOST_RECORDS) {
        return complain(
            Error{fmt::format("stream: a depth of {} is outside of 1 to {}", depth, MOST_RECORDS)});
    }
    // As in LinuxCNC a stream of depth N holds N - 1 records, but one of depth 1 holds one record.
    const unsigned slots = std::max(depth, 2U);
    hal_stream_fifo *fifo = open_fifo(stream, comp, key, fifo_size(slots, static_cast<unsigned>(fields)));
    if (fifo == nullptr) {
        return stream->shmem_id;
    }
    if (fifo->magic == STREAM_MAGIC && fifo->creator != comp && hal_comp_name(fifo->creator) != nullptr) {
        close_fifo(stream);
        return complain(EEXIST, fmt::format("there is a stream with key {} already", key));
    }
    fifo->creator = comp;
    fifo->depth = depth;
    fifo->slots = slots;
    fifo->fields = static_cast<std::uint32_t>(fields);
    std::memcpy(fifo->types, types, sizeof types);
    fifo->sample = 0;
    fifo->in.store(0);
    fifo->out.store(0);
    fifo->overruns.store(0);
    fifo->underruns.store(0);
    fifo->magic = STREAM_MAGIC;
    return 0;
}

void hal_stream_destroy(hal_stream_t *stream) {
    if (stream->fifo != nullptr) {
        stream->fifo->magic = 0;
        close_fifo(stream);
    }
}

int hal_stream_attach(hal_stream_t *stream, int comp, int key, const char *typestring) {
    hal_stream_fifo *fifo = open_fifo(stream, comp, key, sizeof(hal_stream_fifo));
    if (fifo == nullptr) {
        return stream->shmem_id;
    }
    int status = 0;
    if (fifo->magic != STREAM_MAGIC) {
        status = complain(EINVAL, fmt::format("there is no stream with key {}", key));
    } else if (typestring != nullptr) {
        std::uint8_t types[HAL_STREAM_MAX_PINS] = {};
        const int fields = parse_types(typestring, types);
        const bool same = fields == static_cast<int>(fifo->fields) &&
                          std::memcmp(types, fifo->types, static_cast<std::size_t>(fields)) == 0;
        status =
            same ? 0 : complain(EINVAL, fmt::format("stream {} is not of the types '{}'", key, typestring));
    }
    if (status < 0) {
        close_fifo(stream);
    }
    return status;
}

int hal_stream_detach(hal_stream_t *stream) {
    return stream->fifo == nullptr ? -EINVAL : close_fifo(stream);
}

int hal_stream_element_count(hal_stream_t *stream) {
    return static_cast<int>(stream->fifo->fields);
}

hal_type_t hal_stream_element_type(hal_stream_t *stream, int idx) {
    const bool inside = idx >= 0 && idx < static_cast<int>(stream->fifo->fields);
    return inside ? static_cast<hal_type_t>(stream->fifo->types[idx]) : HAL_TYPE_UNSPECIFIED;
}

int hal_stream_write(hal_stream_t *stream, hal_stream_data_u *buf) {
    hal_stream_fifo &fifo = *stream->fifo;
    const std::uint32_t sample = ++fifo.sample;
    const std::uint32_t in = fifo.in.load(std::memory_order_relaxed);
    const std::uint32_t next = in + 1 == fifo.slots ? 0 : in + 1;
    if (next == fifo.out.load(std::memory_order_acquire)) {
        fifo.overruns.fetch_add(1, std::memory_order_relaxed);
        return -ENOSPC;
    }
    hal_stream_data_u *record = record_of(fifo, in);
    record[0].k = sample;
    std::memcpy(record + 1, buf, sizeof(hal_stream_data_u) * fifo.fields);
    fifo.in.store(next, std::memory_order_release);
    return 0;
}

int hal_stream_read(hal_stream_t *stream, hal_stream_data_u *buf, unsigned *sampleno) {
    hal_stream_fifo &fifo = *stream->fifo;
    const std::uint32_t out = fifo.out.load(std::memory_order_relaxed);
    if (fifo.in.load(std::memory_order_acquire) == out) {
        fifo.underruns.fetch_add(1, std::memory_order_relaxed);
        return -ENOSPC;
    }
    const hal_stream_data_u *record = record_of(fifo, out);
    if (sampleno != nullptr) {
        *sampleno = static_cast<unsigned>(record[0].k);
    }
    std::memcpy(buf, record + 1, sizeof(hal_stream_data_u) * fifo.fields);
    fifo.out.store(out + 1 == fifo.slots ? 0 : out + 1, std::memory_order_release);
    return 0;
}

unsigned hal_stream_depth(hal_stream_t *stream) {
    const hal_stream_fifo &fifo = *stream->fifo;
    const std::uint32_t in = fifo.in.load(std::memory_order_acquire);
    const std::uint32_t out = fifo.out.load(std::memory_order_acquire);
    return in >= out ? in - out : in + fifo.slots - out;
}

unsigned hal_stream_maxdepth(hal_stream_t *stream) {
    return stream->fifo->depth;
}

bool hal_stream_readable(hal_stream_t *stream) {
    return hal_stream_depth(stream) > 0;
}

bool hal_stream_writable(hal_stream_t *stream) {
    return hal_stream_depth(stream) + 1 < stream->fifo->slots;
}

int hal_stream_num_underruns(hal_stream_t *stream) {
    return static_cast<int>(stream->fifo->underruns.load(std::memory_order_relaxed));
}

int hal_stream_num_overruns(hal_stream_t *stream) {
    return static_cast<int>(stream->fifo->overruns.load(std::memory_order_relaxed));
}

void hal_stream_wait_readable(hal_stream_t *stream, sig_atomic_t *stop) {
    while (!hal_stream_readable(stream) &&
           (stop == nullptr || *static_cast<volatile sig_atomic_t *>(stop) == 0)) {
        nap();
    }
}

void hal_stream_wait_writable(hal_stream_t *stream, sig_atomic_t *stop) {
    while (!hal_stream_writable(stream) &&
           (stop == nullptr || *static_cast<volatile sig_atomic_t *>(stop) == 0)) {
        nap();
    }
}

}  // extern "C"
