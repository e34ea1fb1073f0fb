// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/output_relay.hh"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace mw {
namespace {

constexpr std::size_t MOST_WAITING = 1 << 18;
constexpr std::size_t PIECE = 1 << 14;
constexpr std::chrono::milliseconds END_PATIENCE{500};

/// One destination of output; both descriptors share it if they point to the same file.
struct Place {
    int target = -1;  ///< original destination
    int pipe_out = -1, pipe_in = -1;
    std::string waiting;
    std::size_t lost = 0;  ///< bytes lost since the last write
    bool writing = false;
    std::string error;
};

struct Relay {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::unique_ptr<Place>> places;
    std::array<Place *, 2> of_descriptor{};  ///< for descriptors 1 and 2
    int wake_out = -1, wake_in = -1;
    bool drain_requested = false, drained = false;
    std::string loss;
};

/// Never destroyed: its threads run until the process ends.
Relay *relay = nullptr;
std::array<int, 2> targets{-1, -1};

/// The thread that runs the machine handles stop signals; SIGPIPE is an error of write() here.
void block_signals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, nullptr);
}

std::string text_of(int error) {
    return std::error_code(error, std::generic_category()).message();
}

/// Reads from the pipe; false when it is empty.
bool take_piece(Place &place) {
    std::array<char, PIECE> piece;
    const ssize_t count = ::read(place.pipe_out, piece.data(), piece.size());
    if (count <= 0) {
        return false;
    }
    const std::lock_guard lock(relay->mutex);
    const auto size = static_cast<std::size_t>(count);
    if (place.waiting.size() + size > MOST_WAITING || !place.error.empty()) {
        place.lost += size;
        relay->loss = place.error.empty() ? "nothing reads it" : place.error;
    } else {
        if (place.lost > 0) {
            place.waiting += "\n[" + std::to_string(place.lost) + " bytes of output were lost here]\n";
            place.lost = 0;
        }
        place.waiting.append(piece.data(), size);
    }
    relay->changed.notify_all();
    return true;
}

void empty_pipes() {
    block_signals();
    std::vector<pollfd> waits;
    for (const auto &place : relay->places) {
        waits.push_back({place->pipe_out, POLLIN, 0});
    }
    waits.push_back({relay->wake_out, POLLIN, 0});
    while (true) {
        if (::poll(waits.data(), waits.size(), -1) < 0) {
            continue;
        }
        for (const auto &place : relay->places) {
            while (take_piece(*place)) {
            }
        }
        if (waits.back().revents != 0) {
            char byte = 0;
            (void)!::read(relay->wake_out, &byte, 1);
            const std::lock_guard lock(relay->mutex);
            relay->drained = relay->drain_requested;
            relay->changed.notify_all();
        }
    }
}

/// Writes all of `text`; returns errno, or 0. Waits for the reader.
int write_all(int target, const std::string &text) {
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t count = ::write(target, text.data() + done, text.size() - done);
        if (count >= 0) {
            done += static_cast<std::size_t>(count);
        } else if (errno == EAGAIN) {
            pollfd wait{target, POLLOUT, 0};
            ::poll(&wait, 1, -1);
        } else if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

void write_out(Place &place) {
    block_signals();
    std::unique_lock lock(relay->mutex);
    while (true) {
        relay->changed.wait(lock, [&] { return !place.waiting.empty(); });
        const std::string text = std::exchange(place.waiting, {});
        place.writing = true;
        lock.unlock();
        const int error = write_all(place.target, text);
        lock.lock();
        place.writing = false;
        if (error != 0) {
            relay->loss = text_of(error);
            // Disk space may become free again; a closed reader does not return.
            place.error = error == ENOSPC ? "" : text_of(error);
        }
        relay->changed.notify_all();
    }
}

bool isSameFile(int one, int other) {
    struct stat a{}, b{};
    return ::fstat(one, &a) == 0 && ::fstat(other, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Makes the pipe of a destination; on false errno has the reason.
bool make_place(int descriptor) {
    auto place = std::make_unique<Place>();
    place->target = targets[static_cast<std::size_t>(descriptor - 1)];
    int ends[2];
    if (place->target < 0 || ::pipe2(ends, O_CLOEXEC) != 0) {
        return false;
    }
    place->pipe_out = ends[0];
    place->pipe_in = ends[1];
    ::fcntl(place->pipe_out, F_SETFL, O_NONBLOCK);
    ::fcntl(place->pipe_in, F_SETPIPE_SZ, static_cast<int>(MOST_WAITING));  // more than 64 kB if permitted
    relay->of_descriptor[static_cast<std::size_t>(descriptor - 1)] = place.get();
    relay->places.push_back(std::move(place));
    return true;
}

bool make_places() {
    int wake[2];
    if (::pipe2(wake, O_CLOEXEC) != 0) {
        return false;
    }
    relay->wake_out = wake[0];
    relay->wake_in = wake[1];
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
        targets[static_cast<std::size_t>(descriptor - 1)] = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 10);
    }
    if (!make_place(STDOUT_FILENO)) {
        return false;
    }
    if (isSameFile(STDOUT_FILENO, STDERR_FILENO)) {
        relay->of_descriptor[1] = relay->of_descriptor[0];
        return true;
    }
    return make_place(STDERR_FILENO);
}

}  // namespace

std::string OutputRelay::begin() {
    if (relay != nullptr) {
        return {};
    }
    std::fflush(stdout);
    std::fflush(stderr);
    relay = new Relay;
    if (!make_places()) {
        return text_of(errno);
    }
    try {
        std::thread(empty_pipes).detach();
        for (const auto &place : relay->places) {
            std::thread(write_out, std::ref(*place)).detach();
        }
    } catch (const std::system_error &error) {
        return error.what();
    }
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
        ::dup2(relay->of_descriptor[static_cast<std::size_t>(descriptor - 1)]->pipe_in, descriptor);
    }
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    return {};
}

std::string OutputRelay::take_loss() {
    if (relay == nullptr) {
        return {};
    }
    const std::lock_guard lock(relay->mutex);
    return relay->loss.empty() ? "" : "the output of this program is lost: " + std::exchange(relay->loss, {});
}

void OutputRelay::end() {
    if (relay == nullptr || relay->of_descriptor[1] == nullptr) {
        return;
    }
    std::fflush(stdout);
    std::fflush(stderr);
    std::unique_lock lock(relay->mutex);
    relay->drain_requested = true;
    (void)!::write(relay->wake_in, "", 1);
    const auto isOut = [](const Place &place) { return place.waiting.empty() && !place.writing; };
    relay->changed.wait_for(lock, END_PATIENCE, [&] {
        return relay->drained &&
               std::ranges::all_of(relay->places, [&](const auto &one) { return isOut(*one); });
    });
    const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
        const Place &place = *relay->of_descriptor[static_cast<std::size_t>(descriptor - 1)];
        const bool good = isOut(place) && place.error.empty();
        ::dup2(good ? targets[static_cast<std::size_t>(descriptor - 1)] : nothing, descriptor);
    }
    ::close(nothing);
}

bool OutputRelay::isTerminal(int descriptor) {
    const int target = targets[static_cast<std::size_t>(descriptor - 1)];
    return ::isatty(target >= 0 ? target : descriptor) == 1;
}

void OutputRelay::restore_in_child() noexcept {
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
        const int target = targets[static_cast<std::size_t>(descriptor - 1)];
        if (target >= 0) {
            ::dup2(target, descriptor);
        }
    }
}

}  // namespace mw
