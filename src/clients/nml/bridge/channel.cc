// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/bridge/channel.hh"

#include <fmt/format.h>

#include "clients/nml/net/remote_buffer.hh"
#include "clients/nml/net/session.hh"

namespace mw::nml {

Result<Channel> Channel::open(const Connections &connections, const std::string &buffer) {
    auto opened = open_any_buffer(connections.config, connections.process, buffer, connections.instance,
                                  connections.local);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    const BufferSettings &settings = *connections.config.find_buffer(buffer);
    const Timeout timeout = connections.config.find_process(connections.process, buffer)->timeout;
    return Channel(std::move(*opened), Codec(connections.vocabulary, encoding_of(settings)), timeout,
                   settings.isNumbered);
}

Result<WriteNumber> Channel::write(const MessageView &message, Timeout timeout) {
    std::string bytes;
    const auto encoded = codec_.encode(message, bytes);
    return encoded.has_value() ? buffer_->write(bytes, timeout) : std::unexpected(encoded.error());
}

Result<std::optional<Message>> Channel::decoded(const Result<bool> &found, const Received &received) const {
    if (!found.has_value()) {
        return std::unexpected(found.error());
    }
    if (!*found) {
        return std::nullopt;
    }
    auto message = codec_.decode(received.bytes);
    if (!message.has_value()) {
        return fail(fmt::format("buffer '{}': {}", buffer_->name(), message.error().message), {},
                    message.error().hint);
    }
    if (CommandHead *head = message->command_head(); head != nullptr && isNumbered_) {
        head->serial_number = received.number;
    }
    return std::optional(std::move(*message));
}

Result<std::optional<Message>> Channel::read() {
    Received received;
    const auto found = receive(received);
    return decoded(found, received);
}

Result<std::optional<Message>> Channel::peek() {
    Received received;
    const auto found = buffer_->peek(received, timeout_);
    return decoded(found, received);
}

Result<std::optional<Message>> Channel::wait(Timeout timeout) {
    Received received;
    const auto found = buffer_->wait(received, timeout);
    return decoded(found, received);
}

}  // namespace mw::nml
