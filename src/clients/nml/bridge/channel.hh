// SPDX-License-Identifier: GPL-2.0-or-later
// A channel of messages: a local or remote buffer of the configuration, with the codec of its encoding.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "clients/nml/buffer/open.hh"
#include "clients/nml/message/codec.hh"

namespace mw::nml {

/// Objects with which a program connects to channels; all must outlive the channels.
struct Connections {
    const Config &config;
    std::string process;  ///< name of the process in P lines
    std::string instance;
    const Vocabulary &vocabulary;
    LocalPlaces &local;
};

/// All calls come from one thread. Waits as set by the timeout in the line of the process.
class Channel {
  public:
    static Result<Channel> open(const Connections &connections, const std::string &buffer);

    /// Writes a message and returns the number of the write. For a buffer with the option `serial` this is
    /// the command's serial number.
    Result<WriteNumber> write(const MessageView &message) { return write(message, timeout_); }
    Result<WriteNumber> write(const MessageView &message, Timeout timeout);
    /// The next unread message; nothing when there is none. Bytes that are not a message are removed and
    /// returned as an error.
    Result<std::optional<Message>> read();
    /// The current message, also if it was read.
    Result<std::optional<Message>> peek();
    /// As read(), but sleeps for a message, at most this long.
    Result<std::optional<Message>> wait(Timeout timeout);

    /// The bytes of the next message, for a reader that decodes them. False: there is no message.
    Result<bool> receive(Received &received) { return buffer_->read(received, timeout_); }
    const Codec &codec() const { return codec_; }
    /// True if the buffer assigns serial numbers to commands.
    bool isNumbered() const { return isNumbered_; }
    Buffer &buffer() { return *buffer_; }

  private:
    Channel(std::unique_ptr<Buffer> buffer, const Codec &codec, Timeout timeout, bool isNumbered)
        : buffer_(std::move(buffer)), codec_(codec), timeout_(timeout), isNumbered_(isNumbered) {}
    Result<std::optional<Message>> decoded(const Result<bool> &found, const Received &received) const;

    std::unique_ptr<Buffer> buffer_;
    Codec codec_;
    Timeout timeout_;
    bool isNumbered_;
};

}  // namespace mw::nml
