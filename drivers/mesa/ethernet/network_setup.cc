// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/ethernet/network_setup.hh"

#include <arpa/inet.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "drivers/mesa/lbp16/packet.hh"

extern char **environ;

namespace mw::mesa {

namespace {

/// A socket that is closed at the end of a scope.
class Socket {
  public:
    Socket() : number_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
    Socket(const Socket &) = delete;
    Socket &operator=(const Socket &) = delete;
    ~Socket() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    int number() const { return number_; }

  private:
    int number_;
};

bool read_address(const std::string &text, sockaddr_in &address) {
    address = {};
    address.sin_family = AF_INET;
    return inet_pton(AF_INET, text.c_str(), &address.sin_addr) == 1;
}

std::string text_of(const in_addr &address) {
    char text[INET_ADDRSTRLEN] = {};
    inet_ntop(AF_INET, &address, text, sizeof text);
    return text;
}

std::string interface_of(const in_addr &own) {
    ifaddrs *all = nullptr;
    if (::getifaddrs(&all) != 0) {
        return {};
    }
    std::string name;
    for (const ifaddrs *one = all; one != nullptr && name.empty(); one = one->ifa_next) {
        if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) {
            continue;
        }
        sockaddr_in address{};
        std::memcpy(&address, one->ifa_addr, sizeof address);
        name = address.sin_addr.s_addr == own.s_addr ? one->ifa_name : "";
    }
    ::freeifaddrs(all);
    return name;
}

/// /proc/net/route has the interface, then the destination; the default route has destination 0.
bool hasDefaultRoute(const std::string &interface) {
    std::ifstream routes("/proc/net/route");
    std::string line;
    std::getline(routes, line);
    while (std::getline(routes, line)) {
        std::istringstream words(line);
        std::string name, destination;
        words >> name >> destination;
        if (name == interface && destination == "00000000") {
            return true;
        }
    }
    return false;
}

arpreq arp_request(const std::string &interface, const sockaddr_in &board) {
    arpreq request{};
    std::memcpy(&request.arp_pa, &board, sizeof board);
    request.arp_ha.sa_family = ARPHRD_ETHER;
    request.arp_flags = ATF_PERM | ATF_COM;
    interface.copy(request.arp_dev, sizeof request.arp_dev - 1);
    return request;
}

/// Runs nft with the text as its standard input. Returns its status, or -1 if it cannot be run.
int run_nft(const std::string &text) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return -1;
    }
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    char name[] = "nft", option[] = "-f", input[] = "-";
    char *const words[] = {name, option, input, nullptr};
    pid_t child = 0;
    const int started = ::posix_spawnp(&child, name, &actions, nullptr, words, environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    // The text fits into a pipe, so the write does not wait.
    const bool written =
        started == 0 && ::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::close(ends[1]);
    int status = 0;
    if (started != 0 || ::waitpid(child, &status, 0) != child || !written || !WIFEXITED(status)) {
        return -1;
    }
    return WEXITSTATUS(status);
}

}  // namespace

Result<BoardRoute> find_route(const std::string &board_address) {
    sockaddr_in board{};
    if (!read_address(board_address, board)) {
        return fail(fmt::format("'{}' is not an IPv4 address such as 192.168.1.121", board_address));
    }
    board.sin_port = htons(lbp16::BOARD_PORT);
    const Socket socket;
    sockaddr_in own{};
    socklen_t size = sizeof own;
    if (::connect(socket.number(), reinterpret_cast<const sockaddr *>(&board), sizeof board) != 0 ||
        ::getsockname(socket.number(), reinterpret_cast<sockaddr *>(&own), &size) != 0) {
        return fail(fmt::format("no network interface reaches the board at {}: {}", board_address,
                                std::strerror(errno)));
    }
    BoardRoute route{.interface = interface_of(own.sin_addr), .own_address = text_of(own.sin_addr)};
    if (route.interface.empty()) {
        return fail(fmt::format("no network interface has the address {}", route.own_address));
    }
    route.has_default_route = hasDefaultRoute(route.interface);
    route.loopback = (ntohl(own.sin_addr.s_addr) >> 24U) == IN_LOOPBACKNET;
    return route;
}

Result<FixedArpEntry> FixedArpEntry::create(const BoardRoute &route, const std::string &board_address,
                                            const MacAddress &mac) {
    sockaddr_in board{};
    if (!read_address(board_address, board)) {
        return fail(fmt::format("'{}' is not an IPv4 address", board_address));
    }
    arpreq request = arp_request(route.interface, board);
    std::memcpy(request.arp_ha.sa_data, mac.data(), mac.size());
    const Socket socket;
    if (::ioctl(socket.number(), SIOCSARP, &request) != 0) {
        return fail(
            fmt::format("no fixed ARP entry for the board at {}: {}", board_address, std::strerror(errno)),
            {},
            "without it a request may wait now and then; give millwright-rt the capability cap_net_admin");
    }
    return FixedArpEntry(route.interface, board_address);
}

FixedArpEntry::FixedArpEntry(FixedArpEntry &&other) noexcept
    : interface_(std::exchange(other.interface_, {})), board_address_(std::move(other.board_address_)) {}

FixedArpEntry::~FixedArpEntry() {
    sockaddr_in board{};
    if (interface_.empty() || !read_address(board_address_, board)) {
        return;
    }
    arpreq request = arp_request(interface_, board);
    const Socket socket;
    ::ioctl(socket.number(), SIOCDARP,
            &request);  // at the end of the program a failure cannot be corrected
}

std::string firewall_rules(const BoardRoute &route, const std::vector<BoardAddress> &boards) {
    const std::string table = "millwright-" + route.interface;
    std::string accepted;
    for (const BoardAddress &board : boards) {
        accepted += fmt::format("    oifname \"{0}\" ip daddr {1} udp dport {2} accept\n"
                                "    oifname \"{0}\" ip daddr {1} icmp type echo-request accept\n",
                                route.interface, board.ip, board.port);
    }
    // Declared, deleted and declared again, so that a table left by a killed process is replaced.
    return fmt::format("table ip {0}\n"
                       "delete table ip {0}\n"
                       "table ip {0} {{\n"
                       "  chain output {{\n"
                       "    type filter hook output priority 0; policy accept;\n"
                       "{2}"
                       "    oifname \"{1}\" drop\n"
                       "  }}\n"
                       "}}\n",
                       table, route.interface, accepted);
}

Result<BoardFirewall> BoardFirewall::create(const BoardRoute &route,
                                            const std::vector<BoardAddress> &boards) {
    if (route.loopback) {
        return fail("the loopback interface is left open");
    }
    if (route.has_default_route) {
        return fail(
            fmt::format("other packets are not kept off {}: it has the default route", route.interface), {},
            "connect the board to a separate network interface");
    }
    if (run_nft(firewall_rules(route, boards)) != 0) {
        return fail(
            fmt::format("other packets are not kept off {}: nft does not accept the rules", route.interface),
            {}, "install nftables, and give millwright-rt the capability cap_net_admin");
    }
    return BoardFirewall("millwright-" + route.interface);
}

BoardFirewall::BoardFirewall(BoardFirewall &&other) noexcept : table_(std::exchange(other.table_, {})) {}

BoardFirewall::~BoardFirewall() {
    if (!table_.empty()) {
        run_nft("delete table ip " + table_ + "\n");
    }
}

}  // namespace mw::mesa
