// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/net/session.hh"

#include <algorithm>

#include <fmt/format.h>

#include "clients/nml/message/codec.hh"

namespace mw::nml {
namespace {

/// Maximum wait of the server for a request. The client then asks again, which shows that the server is
/// alive.
constexpr double LONGEST_WAIT_S = 1.0;
/// Interval of checks whether the client is still connected.
constexpr double SLICE_S = 0.05;

Timeout timeout_of(const Packet &request) {
    return {request.time_ms < 0 ? LONGEST_WAIT_S : std::min(request.time_ms / 1000.0, LONGEST_WAIT_S)};
}

Packet answer_to(const Packet &request, Status status, std::string bytes = {}, std::uint64_t number = 0) {
    Packet packet = {request.operation, status, request.buffer, request.request, number, 0, {}};
    packet.bytes = std::move(bytes);
    return packet;
}

}  // namespace

Encoding encoding_of(const BufferSettings &buffer) {
    const bool for_others = buffer.neutral || buffer.tcp_port.has_value() || buffer.stcp_port.has_value() ||
                            buffer.udp_port.has_value();
    return buffer.encoding.value_or(for_others ? Encoding::XDR : Encoding::RAW);
}

Session::~Session() {
    if (service_.jogs != nullptr) {
        service_.jogs->leave(this);
    }
}

void Session::note_jog(const Message &message) {
    const auto command = message.command();
    if (command.has_value() && service_.jogs != nullptr) {
        service_.jogs->note(this, *command);
    }
}

Packet Session::answer(const Packet &request, const std::function<bool()> &isOver) {
    auto answer = carry_out(request, isOver);
    return answer.has_value() ? std::move(*answer)
                              : answer_to(request, Status::REFUSED, answer.error().str());
}

Result<Session::Open *> Session::find(std::uint32_t number) {
    const auto served = service_.buffers.find(number);
    if (served == service_.buffers.end()) {
        return fail(fmt::format("this server has no buffer# {}", number));
    }
    Open &open = open_[number];
    if (open.buffer == nullptr) {
        auto buffer =
            open_buffer(served->second.buffer, served->second.process, service_.instance, service_.local);
        if (!buffer.has_value()) {
            return std::unexpected(buffer.error());
        }
        open = {&served->second, std::move(*buffer), !served->second.passwords.has_value()};
    }
    return &open;
}

Result<Packet> Session::carry_out(const Packet &request, const std::function<bool()> &isOver) {
    if (request.status != Status::REQUEST) {
        return fail("a server takes requests only");
    }
    const auto open = find(request.buffer);
    if (!open.has_value()) {
        return std::unexpected(open.error());
    }
    if (request.operation == Operation::LOGIN) {
        return log_in(request, **open);
    }
    if (!(*open)->logged_in) {
        return fail(fmt::format("buffer '{}' needs a password", (*open)->buffer->name()), {},
                    "name a password file in its B line: passwd=FILE");
    }
    switch (request.operation) {
    case Operation::WRITE: return write(request, **open);
    case Operation::CLEAR: {
        const auto status = (*open)->buffer->clear(timeout_of(request));
        return status.has_value() ? Result<Packet>(answer_to(request, Status::DONE))
                                  : std::unexpected(status.error());
    }
    case Operation::LOGIN:
    case Operation::READ:
    case Operation::PEEK:
    case Operation::WAIT: break;
    }
    return read(request, **open, isOver);
}

Result<Packet> Session::log_in(const Packet &request, Open &open) {
    const std::size_t zero = request.bytes.find('\0');
    const std::string_view bytes = request.bytes;
    const bool isRight = !open.served->passwords.has_value() ||
                         (zero != std::string::npos &&
                          open.served->passwords->isRight(bytes.substr(0, zero), bytes.substr(zero + 1)));
    open.logged_in = isRight;
    barred_ = !isRight;
    return isRight ? Result<Packet>(answer_to(request, Status::DONE)) : fail("name or password are wrong");
}

Result<Packet> Session::write(const Packet &request, Open &open) {
    // Invalid messages are not passed to other clients.
    const auto message = Codec(service_.vocabulary, encoding_of(open.served->buffer)).decode(request.bytes);
    if (!message.has_value()) {
        return std::unexpected(message.error());
    }
    note_jog(*message);
    const auto number = open.buffer->write(request.bytes, timeout_of(request));
    return number.has_value() ? Result<Packet>(answer_to(request, Status::DONE, {}, *number))
                              : std::unexpected(number.error());
}

Result<Packet> Session::read(const Packet &request, Open &open, const std::function<bool()> &isOver) {
    const bool is_queue = open.served->buffer.is_queue;
    const bool is_peek = request.operation == Operation::PEEK;
    const bool is_wait = request.operation == Operation::WAIT;
    const Deadline deadline(timeout_of(request));
    for (;;) {
        Received message;
        const auto found =
            is_wait                ? open.buffer->wait(message,
                                                       {std::min(SLICE_S, static_cast<double>(deadline.left_ns()) / 1e9)})
            : is_peek || !is_queue ? open.buffer->peek(message, timeout_of(request))
                                   : open.buffer->read(message, timeout_of(request));
        if (!found.has_value()) {
            return std::unexpected(found.error());
        }
        // Each client sends the number of the last message read, so several connections of one client are one
        // reader.
        if (*found && (is_peek || is_queue || message.number > request.number)) {
            return answer_to(request, Status::DONE, std::move(message.bytes), message.number);
        }
        if (!is_wait || deadline.isOver() || isOver()) {
            return answer_to(request, Status::NOTHING);
        }
    }
}

}  // namespace mw::nml
