// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/instance_lock.hh"

#include <pwd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>

namespace mw::runtime {
namespace {

struct Address {
    sockaddr_un name{};
    socklen_t size = 0;
    const sockaddr *get() const { return reinterpret_cast<const sockaddr *>(&name); }
};

/// "@millwright-NAME"; a name that is too long ends with its checksum.
Address address_of(const std::string &instance) {
    Address address;
    std::string text = "millwright-" + instance;
    const std::size_t room = sizeof address.name.sun_path - 1;
    if (text.size() > room) {
        const std::string sum = '-' + std::to_string(std::hash<std::string>{}(instance));
        text = text.substr(0, room - sum.size()) + sum;
    }
    address.name.sun_family = AF_UNIX;
    std::memcpy(address.name.sun_path + 1, text.data(), text.size());
    address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
    return address;
}

std::string user_name(uid_t uid) {
    std::array<char, 4096> buffer;
    passwd entry{};
    passwd *found = nullptr;
    ::getpwuid_r(uid, &entry, buffer.data(), buffer.size(), &found);
    return found != nullptr ? found->pw_name : std::to_string(uid);
}

/// The process that listens, as the kernel reports it: "process 12 (millwright) of user root".
std::string holder(const Address &address) {
    const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    ucred peer{};
    socklen_t size = sizeof peer;
    const bool known = fd >= 0 && ::connect(fd, address.get(), address.size) == 0 &&
                       ::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
    if (fd >= 0) {
        ::close(fd);
    }
    if (!known) {
        return "another process";
    }
    std::string name;
    std::ifstream("/proc/" + std::to_string(peer.pid) + "/comm") >> name;
    return "process " + std::to_string(peer.pid) + (name.empty() ? "" : " (" + name + ")") + " of user " +
           user_name(peer.uid);
}

}  // namespace

InstanceLock::~InstanceLock() {
    if (fd_ >= 0) {
        ::close(fd_);
    }
}

Result<InstanceLock> InstanceLock::take(const std::string &instance) {
    constexpr int QUEUE = 16;  // backlog of processes that query the holder
    const Address address = address_of(instance);
    InstanceLock lock;
    lock.fd_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (lock.fd_ < 0) {
        return fail(std::string("cannot create a socket: ") + std::strerror(errno));
    }
    if (::bind(lock.fd_, address.get(), address.size) != 0) {
        return errno != EADDRINUSE
                   ? fail(std::string("cannot reserve the name of the instance: ") + std::strerror(errno))
                   : fail("Instance '" + instance + "' is in use by " + holder(address) + ".", {},
                          "End that machine, or set MILLWRIGHT_INSTANCE to another name.");
    }
    if (::listen(lock.fd_, QUEUE) != 0) {
        return fail(std::string("cannot listen: ") + std::strerror(errno));
    }
    return lock;
}

}  // namespace mw::runtime
