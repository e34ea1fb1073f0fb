// SPDX-License-Identifier: GPL-2.0-or-later
// hal_port_*: bytes through the queue of a port signal. The value of a port pin is the queue's offset.
#include <time.h>

#include <algorithm>
#include <cstring>

#include "hal/capi/status.hh"
#include "hal/core/port_queue.hh"

using namespace mw::hal;
using namespace mw::hal::capi;

namespace {

/// The queue behind a pin, or null.
PortQueue *queue_of(const hal_port_t *port) noexcept {
    Instance *hal = current();
    if (hal == nullptr || port == nullptr) {
        return nullptr;
    }
    // Acquire: pairs with the release when the queue is made.
    const int offset = __atomic_load_n(port, __ATOMIC_ACQUIRE);
    return static_cast<PortQueue *>(hal->memory().at(static_cast<Reference>(offset)));
}

char *bytes_of(PortQueue &queue) noexcept {
    return reinterpret_cast<char *>(&queue + 1);
}

std::uint32_t used(const PortQueue &queue) noexcept {
    const std::uint32_t in = queue.in.load(std::memory_order_acquire);
    const std::uint32_t out = queue.out.load(std::memory_order_acquire);
    return in >= out ? in - out : in + queue.size - out;
}

std::uint32_t advanced(const PortQueue &queue, std::uint32_t position, std::uint32_t count) noexcept {
    const std::uint32_t end = position + count;
    return end >= queue.size ? end - queue.size : end;
}

void nap() noexcept {
    const timespec time{0, 1'000'000};
    ::nanosleep(&time, nullptr);
}

bool isStopped(const sig_atomic_t *stop) noexcept {
    return stop != nullptr && *static_cast<const volatile sig_atomic_t *>(stop) != 0;
}

}  // namespace

extern "C" {

unsigned hal_port_readable(const hal_port_t *port) {
    const PortQueue *queue = queue_of(port);
    return queue == nullptr ? 0 : used(*queue);
}

unsigned hal_port_writable(const hal_port_t *port) {
    const PortQueue *queue = queue_of(port);
    return queue == nullptr ? 0 : queue->size - 1 - used(*queue);
}

unsigned hal_port_buffer_size(const hal_port_t *port) {
    const PortQueue *queue = queue_of(port);
    return queue == nullptr ? 0 : queue->size;
}

bool hal_port_peek(const hal_port_t *port, char *dest, unsigned count) {
    PortQueue *queue = queue_of(port);
    if (queue == nullptr || used(*queue) < count) {
        return false;
    }
    const std::uint32_t out = queue->out.load(std::memory_order_relaxed);
    const std::uint32_t first = std::min(count, queue->size - out);
    std::memcpy(dest, bytes_of(*queue) + out, first);
    std::memcpy(dest + first, bytes_of(*queue), count - first);
    return true;
}

bool hal_port_peek_commit(const hal_port_t *port, unsigned count) {
    PortQueue *queue = queue_of(port);
    if (queue == nullptr || used(*queue) < count) {
        return false;
    }
    const std::uint32_t out = queue->out.load(std::memory_order_relaxed);
    queue->out.store(advanced(*queue, out, count), std::memory_order_release);
    return true;
}

bool hal_port_read(const hal_port_t *port, char *dest, unsigned count) {
    return hal_port_peek(port, dest, count) && hal_port_peek_commit(port, count);
}

bool hal_port_write(const hal_port_t *port, const char *src, unsigned count) {
    PortQueue *queue = queue_of(port);
    if (queue == nullptr || queue->size - 1 - used(*queue) < count) {
        return false;
    }
    const std::uint32_t in = queue->in.load(std::memory_order_relaxed);
    const std::uint32_t first = std::min(count, queue->size - in);
    std::memcpy(bytes_of(*queue) + in, src, first);
    std::memcpy(bytes_of(*queue), src + first, count - first);
    queue->in.store(advanced(*queue, in, count), std::memory_order_release);
    return true;
}

void hal_port_clear(const hal_port_t *port) {
    if (PortQueue *queue = queue_of(port)) {
        queue->out.store(queue->in.load(std::memory_order_acquire), std::memory_order_release);
    }
}

void hal_port_wait_readable(hal_port_t **port, unsigned count, sig_atomic_t *stop) {
    while (hal_port_readable(*port) < count && !isStopped(stop)) {
        nap();
    }
}

void hal_port_wait_writable(hal_port_t **port, unsigned count, sig_atomic_t *stop) {
    while (hal_port_writable(*port) < count && !isStopped(stop)) {
        nap();
    }
}

}  // extern "C"
