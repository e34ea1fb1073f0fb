// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/host/message.hh"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "hal/core/instance.hh"
#include "runtime/process.hh"
#include "runtime/shared_memory.hh"

namespace mw::hal {
namespace {

void put_count(std::string &out, std::size_t count) {
    const auto value = static_cast<std::uint32_t>(count);
    out.append(reinterpret_cast<const char *>(&value), sizeof value);
}

std::uint32_t count_at(const std::string &buffer, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, buffer.data() + at, sizeof value);
    return value;
}

}  // namespace

std::string encode(const Message &message) {
    std::string body;
    for (const std::string &text : message) {
        put_count(body, text.size());
        body += text;
    }
    std::string out;
    put_count(out, body.size());
    return out + body;
}

Result<bool> decode(std::string &buffer, Message &message) {
    constexpr std::size_t COUNT = sizeof(std::uint32_t);
    if (buffer.size() < COUNT) {
        return false;
    }
    const std::size_t length = count_at(buffer, 0);
    if (length > LONGEST_MESSAGE) {
        return fail("a message is longer than allowed");
    }
    if (buffer.size() < COUNT + length) {
        return false;
    }
    message.clear();
    const std::size_t end = COUNT + length;
    for (std::size_t at = COUNT; at < end;) {
        const std::size_t size = at + COUNT <= end ? count_at(buffer, at) : LONGEST_MESSAGE;
        at += COUNT;
        if (at > end || size > end - at) {
            return fail("a message is not valid");
        }
        message.emplace_back(buffer, at, size);
        at += size;
    }
    buffer.erase(0, end);
    return true;
}

bool isSent(int fd, const Message &message) {
    const std::string text = encode(message);
    for (std::size_t at = 0; at < text.size();) {
        const ssize_t sent = ::send(fd, text.data() + at, text.size() - at, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) {
            continue;
        }
        if (sent <= 0) {
            return false;
        }
        at += static_cast<std::size_t>(sent);
    }
    return true;
}

Result<Message> receive(int fd) {
    std::string buffer;
    Message message;
    while (true) {
        auto whole = decode(buffer, message);
        if (!whole) {
            return std::unexpected(whole.error());
        }
        if (*whole) {
            return message;
        }
        char bytes[4096];
        const ssize_t got = ::recv(fd, bytes, sizeof bytes, 0);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return fail("the realtime process has ended");
        }
        buffer.append(bytes, static_cast<std::size_t>(got));
    }
}

Result<std::string> socket_path(const std::string &instance) {
    auto folder = runtime::runtime_folder();
    if (!folder) {
        return folder;
    }
    return *folder + '/' + instance + ".sock";
}

Result<std::string> lock_path(const std::string &instance) {
    auto folder = runtime::runtime_folder();
    if (!folder) {
        return folder;
    }
    return *folder + '/' + instance + ".lock";
}

namespace {

struct flock whole_file() {
    struct flock whole{};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    return whole;
}

/// True when `path` still refers to the file open as `fd`: its last owner may have removed it.
bool isSameFile(int fd, const std::string &path) {
    struct stat opened{};
    struct stat named{};
    return ::fstat(fd, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
           opened.st_dev == named.st_dev;
}

}  // namespace

Result<int> take_lock(const std::string &instance) {
    const auto path = lock_path(instance);
    if (!path) {
        return std::unexpected(path.error());
    }
    constexpr int TRIES = 100;
    for (int i = 0; i < TRIES; ++i) {
        const int fd = ::open(path->c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (fd < 0) {
            return fail("cannot open " + *path + ": " + std::strerror(errno));
        }
        // The lock belongs to the open file, so it is released when the process ends for any reason.
        struct flock whole = whole_file();
        if (::fcntl(fd, F_OFD_SETLK, &whole) != 0) {
            ::close(fd);
            return -1;
        }
        if (isSameFile(fd, *path)) {
            return fd;
        }
        ::close(fd);
    }
    return fail("the lock " + *path + " is repeatedly removed by another process");
}

void drop_lock(const std::string &instance, int fd) {
    const auto path = lock_path(instance);
    if (path && isSameFile(fd, *path)) {
        ::unlink(path->c_str());
    }
    ::close(fd);
}

bool isLockTaken(const std::string &instance) {
    const auto path = lock_path(instance);
    const int fd = path ? ::open(path->c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW) : -1;
    if (fd < 0) {
        return false;
    }
    struct flock whole = whole_file();
    const bool locked = ::fcntl(fd, F_OFD_GETLK, &whole) == 0 && whole.l_type != F_UNLCK;
    ::close(fd);
    return locked;
}

void remove_leftovers(const std::string &instance) {
    const auto lock = take_lock(instance);
    if (!lock || *lock < 0) {
        return;
    }
    if (const auto socket = socket_path(instance)) {
        ::unlink(socket->c_str());
    }
    runtime::SharedMemory::remove_stale(segment_name(instance));
    drop_lock(instance, *lock);
}

}  // namespace mw::hal
