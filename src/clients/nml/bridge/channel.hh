// SPDX-License-Identifier: GPL-2.0-or-later
// A channel of messages: a buffer of the configuration, local or remote, with the codec of its encoding.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "clients/nml/buffer/open.hh"
#include "clients/nml/message/codec.hh"

namespace mw::nml {

/// What a program connects to channels with; all must outlive them.
struct Connections {
    const Config &config;
    std::string process;  ///< which P lines it goes by
    std::string instance;
    const Vocabulary &vocabulary;
    LocalPlaces &local;
};

/// One thread. Waits as the process's line says: timeout.
class Channel {
  public:
    static Result<Channel> open(const Connections &connections, const std::string &buffer);

    /// The number of the write. Of a buffer with the option `serial` it is the command's serial number.
    Result<WriteNumber> write(const MessageView &message) { return write(message, timeout_); }
    Result<WriteNumber> write(const MessageView &message, Timeout timeout);
    /// The next message that was not read yet; nothing when there is none. Bytes that are no message are an
    /// error, and are taken out.
    Result<std::optional<Message>> read();
    /// The message that is there, read or not.
    Result<std::optional<Message>> peek();
    /// read(), sleeping for a message at most so long.
    Result<std::optional<Message>> wait(Timeout timeout);

    /// The bytes of the next message, for a reader that decodes them itself. False: there is none.
    Result<bool> receive(Received &received) { return buffer_->read(received, timeout_); }
    const Codec &codec() const { return codec_; }
    /// The buffer gives commands their serial numbers.
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
