// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/udp_server.hh"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <fmt/format.h>

#include "base/text.hh"
#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

constexpr std::size_t MAX_DATAGRAM = 2048;
/// Replies are sent to one of the hosts that sent last.
constexpr std::size_t MAX_HOSTS = 64;
/// Maximum delay of a stop signal that arrives just before a wait [ns].
constexpr std::int64_t MAX_WAIT_NS = 200'000'000;

class Socket {
  public:
    Socket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}
    ~Socket() {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
    }
    Socket(const Socket &) = delete;
    Socket &operator=(const Socket &) = delete;
    int descriptor() const { return descriptor_; }

  private:
    int descriptor_;
};

std::int64_t monotonic_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_IN_S + now.tv_nsec;
}

/// True for a request with a read, which advances the virtual time.
bool hasRead(std::span<const std::byte> packet) {
    lbp16::PacketReader reader(packet);
    while (!reader.isAtEnd()) {
        const auto received = reader.next();
        if (received.has_value() && !received->command.writes) {
            return true;
        }
    }
    return false;
}

/// The addresses of the hosts, by number.
class Hosts {
  public:
    int number_of(const sockaddr_in &address) {
        const auto same = [&](const sockaddr_in &one) {
            return one.sin_port == address.sin_port && one.sin_addr.s_addr == address.sin_addr.s_addr;
        };
        const auto known = std::ranges::find_if(addresses_, same);
        if (known != addresses_.end()) {
            return static_cast<int>(known - addresses_.begin());
        }
        if (addresses_.size() < MAX_HOSTS) {
            addresses_.push_back(address);
            return static_cast<int>(addresses_.size()) - 1;
        }
        next_ = (next_ + 1) % MAX_HOSTS;
        addresses_[next_] = address;
        return static_cast<int>(next_);
    }
    const sockaddr_in &operator[](int number) const { return addresses_[static_cast<std::size_t>(number)]; }

  private:
    std::vector<sockaddr_in> addresses_;
    std::size_t next_ = 0;
};

/// The loop of the server.
class Server {
  public:
    Server(Link &link, const ServerSettings &settings, int descriptor)
        : link_(link), settings_(settings), descriptor_(descriptor), start_ns_(monotonic_ns()) {}

    Result<> run(const volatile std::sig_atomic_t &stop) {
        while (stop == 0) {
            wait();
            if (auto received = receive_all(); !received.has_value()) {
                return received;
            }
            send_replies();
        }
        return {};
    }

  private:
    std::int64_t now_ns() const { return settings_.virtual_time ? virtual_ns_ : monotonic_ns() - start_ns_; }

    void wait() {
        std::int64_t wait_ns = MAX_WAIT_NS;
        if (const auto next_ns = link_.next_ns(); next_ns.has_value()) {
            if (!settings_.virtual_time) {
                wait_ns = std::clamp(*next_ns - now_ns(), std::int64_t{0}, MAX_WAIT_NS);
            } else if (*next_ns < request_ns_ + settings_.period_ns) {
                // Events before the next request of the host.
                virtual_ns_ = std::max(virtual_ns_, *next_ns);
                wait_ns = 0;
            }
        }
        pollfd wanted{descriptor_, POLLIN, 0};
        const timespec timeout{wait_ns / NS_IN_S, wait_ns % NS_IN_S};
        ppoll(&wanted, 1, &timeout, nullptr);
    }

    Result<> receive_all() {
        while (true) {
            std::array<std::byte, MAX_DATAGRAM> bytes;
            sockaddr_in from{};
            socklen_t from_size = sizeof from;
            const ssize_t size = recvfrom(descriptor_, bytes.data(), bytes.size(), 0,
                                          reinterpret_cast<sockaddr *>(&from), &from_size);
            if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
                return {};
            }
            // A host has closed its port, and the kernel reports that an earlier reply was not accepted.
            if (size < 0 && errno == ECONNREFUSED) {
                continue;
            }
            if (size < 0) {
                return fail(fmt::format("Cannot receive packets: {}.", std::strerror(errno)));
            }
            const auto packet = std::span(bytes).first(static_cast<std::size_t>(size));
            if (settings_.virtual_time && hasRead(packet)) {
                request_ns_ += settings_.period_ns;
                virtual_ns_ = std::max(virtual_ns_, request_ns_);
            }
            link_.send({packet.begin(), packet.end()}, now_ns(), hosts_.number_of(from));
            send_replies();
        }
    }

    void send_replies() {
        while (const auto reply = link_.receive(now_ns())) {
            const sockaddr_in &to = hosts_[reply->host];
            // A reply that the kernel does not accept is lost, as on a cable.
            sendto(descriptor_, reply->bytes.data(), reply->bytes.size(), 0,
                   reinterpret_cast<const sockaddr *>(&to), sizeof to);
        }
    }

    Link &link_;
    ServerSettings settings_;
    int descriptor_;
    std::int64_t start_ns_;
    std::int64_t virtual_ns_ = 0, request_ns_ = 0;
    Hosts hosts_;
};

}  // namespace

Result<> read_listen_address(const std::string &text, ServerSettings &settings) {
    const std::size_t colon = text.find(':');
    const auto address = text.substr(0, colon);
    const auto port = colon == std::string::npos ? std::optional<std::int64_t>(lbp16::BOARD_PORT)
                                                 : parse_int(text.substr(colon + 1));
    in_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) {
        return fail(fmt::format("'{}' is not an IPv4 address such as 127.0.0.1.", address));
    }
    if (!port.has_value() || *port < 1 || *port > 65535) {
        return fail(fmt::format("'{}' is not a port from 1 to 65535.", text.substr(colon + 1)));
    }
    settings.address = address;
    settings.port = static_cast<std::uint16_t>(*port);
    return {};
}

Result<> serve(Link &link, const ServerSettings &settings, const volatile std::sig_atomic_t &stop) {
    const Socket socket;
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_port = htons(settings.port);
    inet_pton(AF_INET, settings.address.c_str(), &own.sin_addr);
    if (socket.descriptor() < 0 ||
        bind(socket.descriptor(), reinterpret_cast<const sockaddr *>(&own), sizeof own) != 0) {
        return fail(fmt::format("Cannot listen on {}:{}: {}.", settings.address, settings.port,
                                std::strerror(errno)));
    }
    if (settings.listening) {
        settings.listening();
    }
    return Server(link, settings, socket.descriptor()).run(stop);
}

}  // namespace mw::mesa::board
