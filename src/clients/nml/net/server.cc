// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/net/server.hh"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

namespace mw::nml {
namespace {

/// Interval of checks whether the server must end.
constexpr int LOOK_MS = 50;
/// Maximum time in which a client must send and receive a complete message.
constexpr Timeout MESSAGE_TIME{10.0};
/// Space for a name and password, in addition to the largest message.
constexpr std::size_t EXTRA_BYTES = 1024;
/// Number of UDP clients whose last answer is stored.
constexpr std::size_t MAX_DATAGRAM_CLIENTS = 64;
constexpr std::size_t MAX_DATAGRAM = 65507;

bool isReadable(int fd) {
    pollfd one{fd, POLLIN, 0};
    return ::poll(&one, 1, LOOK_MS) > 0;
}

/// Requests of one address, stored so that a repeated request is executed only once.
struct DatagramClient {
    std::unique_ptr<Session> session;
    std::uint32_t last_request = 0;
    std::string last_answer;
    std::uint64_t used = 0;
};

}  // namespace

Result<std::unique_ptr<Server>> Server::start(const Config &config, const std::string &process,
                                              const std::string &instance, const Vocabulary &vocabulary,
                                              LocalPlaces &local) {
    Service service{{}, vocabulary, instance, local, 0, nullptr};
    std::set<std::tuple<std::string, int, Transport>> places;
    for (const BufferSettings &buffer : config.buffers) {
        const ProcessSettings *line = config.find_process(process, buffer.name);
        if (line == nullptr || !line->is_server) {
            continue;
        }
        for (const auto &port : {buffer.tcp_port, buffer.stcp_port}) {
            if (port.has_value()) {
                places.emplace(buffer.host, *port, Transport::TCP);
            }
        }
        if (buffer.udp_port.has_value()) {
            places.emplace(buffer.host, *buffer.udp_port, Transport::UDP);
        }
        ServedBuffer served{buffer, *line, {}};
        served.process.isMaster = false;  // connections of clients do not create memory
        if (!buffer.password_file.empty()) {
            auto passwords = Passwords::load(buffer.password_file);
            if (!passwords.has_value()) {
                return std::unexpected(passwords.error());
            }
            served.passwords = std::move(*passwords);
        }
        service.longest = std::max(service.longest, buffer.size);
        const auto number = static_cast<std::uint32_t>(buffer.buffer_number);
        if (!service.buffers.emplace(number, std::move(served)).second) {
            return fail(fmt::format("process '{}' serves two buffers with buffer# {}", process, number),
                        buffer.place);
        }
    }
    std::unique_ptr<Server> server(new Server(std::move(service)));
    for (const auto &[host, port, transport] : places) {
        const auto status = server->listen(host, port, transport);
        if (!status.has_value()) {
            return std::unexpected(status.error());
        }
    }
    return server;
}

Server::~Server() {
    isEnding_ = true;
    for (Listener &listener : listeners_) {
        listener.thread.join();
    }
}

int Server::tcp_port() const {
    const auto found = std::find_if(listeners_.begin(), listeners_.end(),
                                    [](const Listener &one) { return one.transport == Transport::TCP; });
    return found == listeners_.end() ? 0 : found->port;
}

int Server::udp_port() const {
    const auto found = std::find_if(listeners_.begin(), listeners_.end(),
                                    [](const Listener &one) { return one.transport == Transport::UDP; });
    return found == listeners_.end() ? 0 : found->port;
}

Result<> Server::listen(const std::string &host, int port, Transport transport) {
    auto socket = listen_at(host, port, transport);
    if (!socket.has_value()) {
        return std::unexpected(socket.error());
    }
    Listener &listener = listeners_.emplace_back();
    listener.socket = std::move(*socket);
    listener.transport = transport;
    listener.port = port;
    listener.thread = std::thread([this, &listener] {
        if (listener.transport == Transport::TCP) {
            accept(listener);
        } else {
            serve_datagrams(listener);
        }
    });
    return {};
}

void Server::accept(Listener &listener) {
    while (!isEnding_) {
        if (isReadable(listener.socket.fd())) {
            take_client(listener);
        }
        for (Worker &worker : listener.workers) {
            if (worker.isDone) {
                worker.thread.join();
            }
        }
        listener.workers.remove_if(
            [](const Worker &worker) { return worker.isDone.load() && !worker.thread.joinable(); });
    }
    for (Worker &worker : listener.workers) {
        worker.socket.shut_down();
        worker.thread.join();
    }
}

void Server::take_client(Listener &listener) {
    Socket client(::accept4(listener.socket.fd(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!client.isOpen()) {
        return;
    }
    if (listener.workers.size() >= MAX_SESSIONS) {
        const Packet full{
            Operation::PEEK, Status::REFUSED, 0, 0, 0, 0, "the server has as many clients as it can have"};
        static_cast<void>(
            // a client that misses this packet sees a closed connection
            client.send_packet(full, Deadline(AT_ONCE)));
        return;
    }
    Worker &worker = listener.workers.emplace_back(std::move(client));
    worker.thread = std::thread([this, &worker] {
        serve(worker);
        worker.isDone = true;
    });
}

void Server::serve(Worker &worker) {
    Session session(service_);
    const auto isOver = [this, &worker] { return isEnding_.load() || worker.socket.isHungUp(); };
    while (!isEnding_ && !session.isBarred()) {
        if (!isReadable(worker.socket.fd())) {
            continue;
        }
        Packet request;
        const auto received = worker.socket.receive_packet(request, Deadline(MESSAGE_TIME), MESSAGE_TIME,
                                                           service_.longest + EXTRA_BYTES);
        if (!received.has_value()) {  // the following bytes cannot be understood
            const Packet answer{Operation::PEEK, Status::REFUSED, 0, 0, 0, 0, received.error().message};
            static_cast<void>(worker.socket.send_packet(answer, Deadline(MESSAGE_TIME)));
            break;
        }
        // A client that has closed its connection has reported a failure, so its command must not move the
        // machine later.
        if (!*received || worker.socket.isHungUp() ||
            !worker.socket.send_packet(session.answer(request, isOver), Deadline(MESSAGE_TIME)).has_value()) {
            break;
        }
    }
    worker.socket.shut_down();
}

void Server::serve_datagrams(Listener &listener) {
    std::map<std::string, DatagramClient> clients;
    std::string bytes(MAX_DATAGRAM, '\0');
    std::uint64_t count = 0;
    while (!isEnding_) {
        sockaddr_storage address{};
        socklen_t size = sizeof address;
        if (!isReadable(listener.socket.fd())) {
            continue;
        }
        const ssize_t got = ::recvfrom(listener.socket.fd(), bytes.data(), bytes.size(), 0,
                                       reinterpret_cast<sockaddr *>(&address), &size);
        std::size_t expected = 0;
        const std::string_view datagram(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        auto request = read_packet_head(datagram, expected);
        if (!request.has_value() || expected != datagram.size() - PACKET_HEAD) {
            continue;  // anybody may send anything, so data that are not a request receive no answer
        }
        request->bytes = datagram.substr(PACKET_HEAD);
        request->time_ms = 0;  // there is one thread for all clients, so no client may wait
        DatagramClient &client = clients[std::string(reinterpret_cast<const char *>(&address), size)];
        client.used = ++count;
        const bool is_new = client.session == nullptr || request->request != client.last_request;
        if (client.session == nullptr || client.session->isBarred()) {
            client.session = std::make_unique<Session>(service_);
        }
        if (is_new) {
            client.last_request = request->request;
            client.last_answer = to_wire(client.session->answer(*request, [] { return true; }));
        }
        // A lost answer, or one that is too large for a datagram, is requested again or ends with the
        // timeout.
        static_cast<void>(::sendto(listener.socket.fd(), client.last_answer.data(), client.last_answer.size(),
                                   0, reinterpret_cast<const sockaddr *>(&address), size));
        if (clients.size() > MAX_DATAGRAM_CLIENTS) {
            clients.erase(std::min_element(clients.begin(), clients.end(), [](const auto &a, const auto &b) {
                return a.second.used < b.second.used;
            }));
        }
    }
}

}  // namespace mw::nml
