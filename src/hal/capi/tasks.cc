// SPDX-License-Identifier: GPL-2.0-or-later
// rtapi.h: tasks, semaphores, queues of bytes.
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>

#include "hal/capi/status.hh"
#include "hal/core/crash_report.hh"
#include "runtime/alternate_stack.hh"
#include "runtime/scheduler.hh"

using namespace mw;
using namespace mw::hal;
using namespace mw::hal::capi;

namespace {

constexpr int PRIORITY_HIGHEST = 80;
constexpr int PRIORITY_LOWEST = 1;
constexpr std::int64_t NS_PER_S = 1000000000;
constexpr int DELETE_TIMEOUT_S = 2;
constexpr std::size_t LEAST_STACK = 384UL * 1024;

std::int64_t monotonic_ns() noexcept {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

struct Task {
    int id = 0;
    void (*code)(void *) = nullptr;
    void *argument = nullptr;
    int priority = PRIORITY_LOWEST;
    std::size_t stack_size = 0;
    Instance *hal = nullptr;
    std::int64_t period_ns = 0;  ///< 0: free-running
    std::int64_t next_ns = 0;    ///< of the task's thread
    pthread_t thread{};
    bool started = false;
    std::mutex mutex;
    pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
    // Released by the requesting thread, acquired by the task in rtapi_wait before it acts.
    std::atomic<bool> isPaused{false};
    std::atomic<bool> ending{false};
};

Task *&own_task() noexcept {
    thread_local Task *task = nullptr;
    return task;
}

/// Objects of the C API that have ids, in this process.
struct Registry {
    std::mutex mutex;  ///< guards creating and deleting
    std::map<int, std::unique_ptr<Task>> tasks;
    int last_id = 0;
};

/// A semaphore in a fixed slot, so that rtapi_sem_give and rtapi_sem_try find it without a lock.
struct Semaphore {
    // Released after the other fields are filled; 0: free. An id is the slot number plus a multiple of
    // SEMAPHORES.
    std::atomic<int> id{0};
    const Instance *hal = nullptr;
    int key = 0;
    int users = 0;
    sem_t sem{};
};
constexpr int SEMAPHORES = 64;

std::array<Semaphore, SEMAPHORES> &semaphores() {
    static auto *all = new std::array<Semaphore, SEMAPHORES>;
    return *all;
}

Semaphore *find_semaphore(int id) noexcept {
    if (id <= 0) {
        return nullptr;
    }
    Semaphore &semaphore = semaphores()[static_cast<std::size_t>(id % SEMAPHORES)];
    return semaphore.id.load(std::memory_order_acquire) == id ? &semaphore : nullptr;
}

Registry &registry() {
    // Never destroyed: tasks may outlive main.
    static auto *the_registry = new Registry;
    return *the_registry;
}

Task *find_task(int id) {
    Registry &all = registry();
    const std::lock_guard lock(all.mutex);
    const auto found = all.tasks.find(id);
    return found == all.tasks.end() ? nullptr : found->second.get();
}

void *run_task(void *argument) {
    auto *task = static_cast<Task *>(argument);
    own_task() = task;
    const UseInstance use(task->hal);
    const runtime::AlternateStack for_crashes;
    set_activity("a task of a module (rtapi_task_start)");
    task->code(task->argument);
    return nullptr;
}

int start(Task &task, std::int64_t period_ns) {
    task.period_ns = period_ns;
    task.next_ns = monotonic_ns() + period_ns;
    pthread_attr_t attributes;
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setstacksize(&attributes, std::max(task.stack_size, LEAST_STACK));
    const int error = ::pthread_create(&task.thread, &attributes, &run_task, &task);
    ::pthread_attr_destroy(&attributes);
    if (error != 0) {
        return complain(error, fmt::format("task {} does not start: {}", task.id, std::strerror(error)));
    }
    task.started = true;
    if (task.hal->host_status().isRealtime()) {
        sched_param param{};
        param.sched_priority = task.priority;
        ::pthread_setschedparam(task.thread, SCHED_FIFO, &param);
    }
    return 0;
}

void wake(Task &task) {
    const std::lock_guard lock(task.mutex);
    ::pthread_cond_broadcast(&task.changed);
}

/// The queue of rtapi_fifo_*, at the start of a block of the instance. Positions wrap at 2^32.
struct Fifo {
    std::uint32_t size;  ///< a power of two
    // Released by the writer after the bytes are in place, acquired by the reader before it copies them.
    std::atomic<std::uint32_t> in;
    // Released by the reader after its copy, acquired by the writer before it fills the bytes again.
    std::atomic<std::uint32_t> out;

    char *bytes() noexcept { return reinterpret_cast<char *>(this + 1); }
};

/// Keys of queues must not collide with those of rtapi_shmem_new.
constexpr int FIFO_KEY = 0x52540000;

Fifo *find_fifo(int id) {
    Instance *hal = current();
    return hal == nullptr ? nullptr : static_cast<Fifo *>(hal->memory().checked_at(id, sizeof(Fifo)));
}

}  // namespace

extern "C" {

int rtapi_prio_highest(void) {
    return PRIORITY_HIGHEST;
}

int rtapi_prio_lowest(void) {
    return PRIORITY_LOWEST;
}

int rtapi_prio_next_higher(int prio) {
    return std::clamp(prio + 1, PRIORITY_LOWEST, PRIORITY_HIGHEST);
}

int rtapi_prio_next_lower(int prio) {
    return std::clamp(prio - 1, PRIORITY_LOWEST, PRIORITY_HIGHEST);
}

int rtapi_task_new(void (*taskcode)(void *), void *arg, int prio, int /*owner*/, unsigned long int stacksize,
                   int /*uses_fp*/) {
    return with_hal([&](Instance &hal) {
        if (taskcode == nullptr || prio < PRIORITY_LOWEST || prio > PRIORITY_HIGHEST) {
            return complain(EINVAL, "a task needs code and a priority of rtapi_prio_*");
        }
        if (hal.isVirtual()) {
            return complain(ENOSYS, "separate tasks need the realtime clock; export a HAL function instead");
        }
        Registry &all = registry();
        const std::lock_guard lock(all.mutex);
        auto task = std::make_unique<Task>();
        task->id = ++all.last_id;
        task->code = taskcode;
        task->argument = arg;
        task->priority = prio;
        task->stack_size = stacksize;
        task->hal = &hal;
        const int id = task->id;
        all.tasks.emplace(id, std::move(task));
        return id;
    });
}

int rtapi_task_delete(int task_id) {
    Task *task = find_task(task_id);
    if (task == nullptr || task == own_task()) {
        return -EINVAL;
    }
    task->ending.store(true, std::memory_order_release);
    wake(*task);
    if (task->started) {
        timespec end{};
        ::clock_gettime(CLOCK_REALTIME, &end);
        end.tv_sec += DELETE_TIMEOUT_S;
        if (::pthread_timedjoin_np(task->thread, nullptr, &end) != 0) {
            return complain(EBUSY,
                            fmt::format("task {} does not call rtapi_wait, so it cannot be ended", task_id));
        }
    }
    Registry &all = registry();
    const std::lock_guard lock(all.mutex);
    all.tasks.erase(task_id);
    return 0;
}

int rtapi_task_start(int task_id, unsigned long int period_nsec) {
    Task *task = find_task(task_id);
    if (task == nullptr || task->started || period_nsec == 0) {
        return -EINVAL;
    }
    return start(*task, static_cast<std::int64_t>(period_nsec));
}

int rtapi_task_resume(int task_id) {
    Task *task = find_task(task_id);
    if (task == nullptr) {
        return -EINVAL;
    }
    if (!task->started) {
        return start(*task, 0);
    }
    task->isPaused.store(false, std::memory_order_release);
    wake(*task);
    return 0;
}

int rtapi_task_pause(int task_id) {
    Task *task = find_task(task_id);
    if (task == nullptr || !task->started) {
        return -EINVAL;
    }
    task->isPaused.store(true, std::memory_order_release);
    return 0;
}

int rtapi_task_self(void) {
    const Task *task = own_task();
    return task == nullptr ? -EINVAL : task->id;
}

int rtapi_wait(void) {
    Task *task = own_task();
    if (task == nullptr) {
        return -EINVAL;
    }
    if (task->period_ns > 0) {
        const timespec until{task->next_ns / NS_PER_S, task->next_ns % NS_PER_S};
        while (!task->ending.load(std::memory_order_acquire) &&
               ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
        }
        task->next_ns += task->period_ns;
    }
    std::unique_lock lock(task->mutex);
    while (task->isPaused.load(std::memory_order_acquire) && !task->ending.load(std::memory_order_acquire)) {
        ::pthread_cond_wait(&task->changed, task->mutex.native_handle());
    }
    lock.unlock();
    if (task->ending.load(std::memory_order_acquire)) {
        ::pthread_exit(nullptr);
    }
    return 0;
}

void rtapi_task_self_resync(void) {
    if (Task *task = own_task(); task != nullptr && task->period_ns > 0) {
        const std::int64_t now = monotonic_ns();
        if (task->next_ns < now) {
            task->next_ns += ((now - task->next_ns) / task->period_ns + 1) * task->period_ns;
        }
    }
}

long long rtapi_task_pll_get_reference(void) {
    Instance *hal = current();
    return hal == nullptr || hal->scheduler() == nullptr ? 0 : hal->scheduler()->current_release_ns();
}

int rtapi_task_pll_set_correction(long value) {
    Instance *hal = current();
    const bool set =
        hal != nullptr && hal->scheduler() != nullptr && hal->scheduler()->set_correction_ns(value);
    return set ? 0 : -EINVAL;
}

// ---- semaphores

int rtapi_sem_new(int key, int /*module_id*/) {
    return with_hal([&](Instance &hal) {
        Registry &all = registry();
        const std::lock_guard lock(all.mutex);
        Semaphore *vacant = nullptr;
        for (Semaphore &one : semaphores()) {
            const int id = one.id.load(std::memory_order_relaxed);
            if (id != 0 && one.hal == &hal && one.key == key) {
                ++one.users;
                return id;
            }
            vacant = id == 0 && vacant == nullptr ? &one : vacant;
        }
        if (vacant == nullptr) {
            return complain(ENOSPC, fmt::format("there are {} semaphores already", SEMAPHORES));
        }
        ::sem_init(&vacant->sem, 0, 1);
        vacant->hal = &hal;
        vacant->key = key;
        vacant->users = 1;
        const int place = static_cast<int>(vacant - semaphores().data());
        const int id = ++all.last_id * SEMAPHORES + place;
        vacant->id.store(id, std::memory_order_release);
        return id;
    });
}

int rtapi_sem_delete(int sem_id, int /*module_id*/) {
    Registry &all = registry();
    const std::lock_guard lock(all.mutex);
    Semaphore *semaphore = find_semaphore(sem_id);
    if (semaphore == nullptr) {
        return -EINVAL;
    }
    if (--semaphore->users == 0) {
        semaphore->id.store(0, std::memory_order_release);
        ::sem_destroy(&semaphore->sem);
    }
    return 0;
}

int rtapi_sem_give(int sem_id) {
    Semaphore *semaphore = find_semaphore(sem_id);
    if (semaphore == nullptr) {
        return -EINVAL;
    }
    // An RTAPI semaphore is a lock: a second give has no effect.
    int value = 0;
    ::sem_getvalue(&semaphore->sem, &value);
    return value > 0 || ::sem_post(&semaphore->sem) == 0 ? 0 : -errno;
}

int rtapi_sem_take(int sem_id) {
    Semaphore *semaphore = find_semaphore(sem_id);
    if (semaphore == nullptr) {
        return -EINVAL;
    }
    while (::sem_wait(&semaphore->sem) != 0) {
        if (errno != EINTR) {
            return -errno;
        }
    }
    return 0;
}

int rtapi_sem_try(int sem_id) {
    Semaphore *semaphore = find_semaphore(sem_id);
    if (semaphore == nullptr) {
        return -EINVAL;
    }
    return ::sem_trywait(&semaphore->sem) == 0 ? 0 : -EBUSY;
}

// ---- queues of bytes

int rtapi_fifo_new(int key, int /*module_id*/, unsigned long int size, char mode) {
    return with_hal([&](Instance &hal) {
        const bool is_mode = mode == 'R' || mode == 'r' || mode == 'W' || mode == 'w';
        if (!is_mode || size == 0 || size > (1U << 27U) || key == 0) {
            return complain(EINVAL, "a queue needs a key, a size above 0 and the mode R or W");
        }
        const auto room = std::bit_ceil(static_cast<std::uint32_t>(size));
        const auto block = hal.memory().open_block(key ^ FIFO_KEY, sizeof(Fifo) + room);
        if (!block) {
            return complain(block.error());
        }
        // If two processes open the queue at the same time, only one sets the size.
        std::uint32_t unset = 0;
        std::atomic_ref(static_cast<Fifo *>(hal.memory().at(block->memory))->size)
            .compare_exchange_strong(unset, room);
        return static_cast<int>(block->memory);
    });
}

int rtapi_fifo_delete(int fifo_id, int /*module_id*/) {
    return with_hal([&](Instance &hal) {
        return fifo_id > 0 && hal.memory().close_block_at(static_cast<Reference>(fifo_id)) ? 0 : -EINVAL;
    });
}

int rtapi_fifo_read(int fifo_id, char *buf, unsigned long int size) {
    Fifo *fifo = find_fifo(fifo_id);
    if (fifo == nullptr || buf == nullptr) {
        return -EINVAL;
    }
    const std::uint32_t out = fifo->out.load(std::memory_order_relaxed);
    const std::uint32_t there = fifo->in.load(std::memory_order_acquire) - out;
    const auto count = static_cast<std::uint32_t>(std::min<unsigned long>(there, size));
    for (std::uint32_t i = 0; i < count; ++i) {
        buf[i] = fifo->bytes()[(out + i) & (fifo->size - 1)];
    }
    fifo->out.store(out + count, std::memory_order_release);
    return static_cast<int>(count);
}

int rtapi_fifo_write(int fifo_id, char *buf, unsigned long int size) {
    Fifo *fifo = find_fifo(fifo_id);
    if (fifo == nullptr || buf == nullptr) {
        return -EINVAL;
    }
    const std::uint32_t in = fifo->in.load(std::memory_order_relaxed);
    const std::uint32_t room = fifo->size - (in - fifo->out.load(std::memory_order_acquire));
    const auto count = static_cast<std::uint32_t>(std::min<unsigned long>(room, size));
    for (std::uint32_t i = 0; i < count; ++i) {
        fifo->bytes()[(in + i) & (fifo->size - 1)] = buf[i];
    }
    fifo->in.store(in + count, std::memory_order_release);
    return static_cast<int>(count);
}

}  // extern "C"
