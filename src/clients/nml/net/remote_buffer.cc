// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/net/remote_buffer.hh"

#include <time.h>

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "clients/nml/buffer/open.hh"
#include "clients/nml/net/passwords.hh"

namespace mw::nml {
namespace {

/// Time for the network and a busy server, in addition to the time of the access.
constexpr double PATIENCE_S = 5.0;
/// A datagram is sent again if there is no answer within this time.
constexpr double DATAGRAM_PATIENCE_S = 0.2;
/// Interval of requests for a message over UDP, because the server does not wait.
constexpr std::int64_t ASK_AGAIN_NS = 10000000;
constexpr std::size_t MAX_DATAGRAM = 65507;

void sleep_ns(std::int64_t ns) {
    const timespec time{0, ns};
    ::nanosleep(&time, nullptr);
}

class RemoteBuffer final : public Buffer {
  public:
    RemoteBuffer(const BufferSettings &settings, Rights rights, std::optional<Credentials> credentials)
        : Buffer(settings.name, rights), host_(settings.host),
          port_(settings.tcp_port.value_or(settings.stcp_port.value_or(settings.udp_port.value_or(0)))),
          transport_(settings.tcp_port.has_value() || settings.stcp_port.has_value() ? Transport::TCP
                                                                                     : Transport::UDP),
          number_(static_cast<std::uint32_t>(settings.buffer_number)), longest_(settings.size),
          credentials_(std::move(credentials)), isBlockingAllowed_(settings.isBlockingAllowed()) {}

    Result<> connect() {
        auto socket = connect_to(host_, port_, transport_, Deadline({PATIENCE_S}));
        if (!socket.has_value()) {
            return bad(socket.error().message, "is its server running?");
        }
        socket_ = std::move(*socket);
        seen_ = 0;  // the server may have started again and count from 1
        if (!credentials_.has_value()) {
            return {};
        }
        const auto answer =
            exchange(Operation::LOGIN, credentials_->name + '\0' + credentials_->password, AT_ONCE);
        if (!answer.has_value()) {
            socket_.close();
            return std::unexpected(answer.error());
        }
        return {};
    }

  private:
    Result<> need_connection() { return socket_.isOpen() ? Result<>{} : connect(); }

    Result<Packet> ask(Operation operation, std::string bytes, Timeout timeout) {
        const auto connected = need_connection();
        return connected.has_value() ? exchange(operation, std::move(bytes), timeout)
                                     : std::unexpected(connected.error());
    }

    Result<Packet> exchange(Operation operation, std::string bytes, Timeout timeout) {
        Packet request{operation, Status::REQUEST, number_, ++request_, seen_, -1, std::move(bytes)};
        constexpr double MOST_MS = 1e9;
        request.time_ms =
            timeout.isForever() ? -1 : static_cast<std::int32_t>(std::min(timeout.seconds * 1e3, MOST_MS));
        const bool isForever = timeout.isForever();
        const Deadline deadline({(isForever ? 1.0 : std::min(timeout.seconds, 1.0)) + PATIENCE_S});
        auto answer = transport_ == Transport::TCP ? exchange_stream(request, deadline)
                                                   : exchange_datagrams(request, deadline);
        if (!answer.has_value()) {
            socket_.close();  // a late answer must not be treated as the answer to another request
            const bool is_change = operation == Operation::WRITE || operation == Operation::CLEAR;
            return bad(answer.error().message,
                       is_change ? "whether it was carried out is not known" : "is its server running?");
        }
        if (answer->status == Status::REFUSED) {
            return bad(fmt::format("its server says: {}", answer->bytes));
        }
        return answer;
    }

    Result<Packet> exchange_stream(const Packet &request, const Deadline &deadline) {
        const auto sent = socket_.send_packet(request, deadline);
        if (!sent.has_value()) {
            return std::unexpected(sent.error());
        }
        Packet answer;
        const auto received = socket_.receive_packet(answer, deadline, {PATIENCE_S}, longest_ + MAX_ERROR);
        if (!received.has_value() || !*received) {
            return received.has_value() ? fail("its server has closed the connection")
                                        : std::unexpected(received.error());
        }
        // A server that does not understand a request cannot name it.
        const bool ours = answer.request == request.request || answer.status == Status::REFUSED;
        return ours ? Result<Packet>(std::move(answer)) : fail("its server answers something else");
    }

    Result<Packet> exchange_datagrams(const Packet &request, const Deadline &deadline) {
        const std::string wire = to_wire(request);
        if (wire.size() > MAX_DATAGRAM) {
            return fail(fmt::format("{} bytes are more than UDP can send at once", wire.size()));
        }
        std::string bytes(MAX_DATAGRAM, '\0');
        while (!deadline.isOver()) {
            const auto sent = socket_.send(wire, deadline);
            if (!sent.has_value()) {
                return std::unexpected(sent.error());
            }
            const Deadline once({DATAGRAM_PATIENCE_S});
            while (!once.isOver()) {
                const auto got = socket_.receive_datagram(bytes.data(), bytes.size(), once);
                if (!got.has_value()) {
                    return std::unexpected(got.error());
                }
                std::size_t size = 0;
                auto answer = read_packet_head(std::string_view(bytes).substr(0, *got), size);
                if (answer.has_value() && answer->request == request.request && size == *got - PACKET_HEAD) {
                    answer->bytes = bytes.substr(PACKET_HEAD, size);
                    return answer;
                }
            }
        }
        return fail("no answer came");
    }

    Result<WriteNumber> put(std::string_view bytes, Timeout timeout) override {
        const auto answer = ask(Operation::WRITE, std::string(bytes), timeout);
        return answer.has_value() ? Result<WriteNumber>(answer->number) : std::unexpected(answer.error());
    }

    Result<bool> got(Result<Packet> answer, Received &message) {
        if (!answer.has_value()) {
            return std::unexpected(answer.error());
        }
        if (answer->status != Status::DONE) {
            return false;
        }
        message.bytes = std::move(answer->bytes);
        message.number = answer->number;
        return true;
    }

    Result<bool> take(Received &message, Timeout timeout) override {
        const auto found = got(ask(Operation::READ, {}, timeout), message);
        seen_ = found.has_value() && *found ? message.number : seen_;
        return found;
    }

    Result<bool> look(Received &message, Timeout timeout) override {
        return got(ask(Operation::PEEK, {}, timeout), message);
    }

    Result<bool> take_next(Received &message, Timeout timeout) override {
        if (!isBlockingAllowed_) {
            return bad("waits for its messages are disabled", "see bsem=-1 in its B line");
        }
        const Deadline deadline(timeout);
        for (;;) {
            const Timeout left{timeout.isForever() ? -1 : static_cast<double>(deadline.left_ns()) / 1e9};
            const auto found = got(ask(Operation::WAIT, {}, left), message);
            if (!found.has_value() || *found || deadline.isOver()) {
                seen_ = found.has_value() && *found ? message.number : seen_;
                return found;
            }
            if (transport_ == Transport::UDP) {
                sleep_ns(std::min(deadline.left_ns(), ASK_AGAIN_NS));
            }
        }
    }

    Result<> empty(Timeout timeout) override {
        const auto answer = ask(Operation::CLEAR, {}, timeout);
        return answer.has_value() ? Result<>{} : std::unexpected(answer.error());
    }

    /// Space for the text of an error.
    static constexpr std::size_t MAX_ERROR = 4096;

    std::string host_;
    int port_;
    Transport transport_;
    std::uint32_t number_;
    std::size_t longest_;
    std::optional<Credentials> credentials_;
    bool isBlockingAllowed_;
    Socket socket_;
    std::uint32_t request_ = 0;
    WriteNumber seen_ = 0;
};

}  // namespace

Result<std::unique_ptr<Buffer>> open_remote_buffer(const BufferSettings &buffer,
                                                   const ProcessSettings &process) {
    if (!buffer.tcp_port.has_value() && !buffer.stcp_port.has_value() && !buffer.udp_port.has_value()) {
        return fail(fmt::format("buffer '{}': process '{}' is REMOTE, but the buffer has no port",
                                buffer.name, process.name),
                    process.place, "add TCP=PORT to its B line");
    }
    std::optional<Credentials> credentials;
    if (!buffer.password_file.empty()) {
        const auto passwords = Passwords::load(buffer.password_file);
        if (!passwords.has_value()) {
            return std::unexpected(passwords.error());
        }
        credentials = passwords->first();
    }
    auto made = std::make_unique<RemoteBuffer>(buffer, Rights{process.mayRead, process.mayWrite},
                                               std::move(credentials));
    const auto connected = made->connect();
    if (!connected.has_value()) {
        return std::unexpected(connected.error());
    }
    return made;
}

Result<std::unique_ptr<Buffer>> open_any_buffer(const Config &config, const std::string &process,
                                                const std::string &buffer, const std::string &instance,
                                                LocalPlaces &local) {
    const BufferSettings *settings = config.find_buffer(buffer);
    const ProcessSettings *line = config.find_process(process, buffer);
    if (settings == nullptr || line == nullptr) {
        return fail(
            fmt::format("the NML configuration has no {} line for {}'{}'", settings == nullptr ? 'B' : 'P',
                        settings == nullptr ? "buffer " : "process '" + process + "' and buffer ", buffer));
    }
    return line->isRemote ? open_remote_buffer(*settings, *line)
                          : open_buffer(*settings, *line, instance, local);
}

}  // namespace mw::nml
