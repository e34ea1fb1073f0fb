// SPDX-License-Identifier: GPL-2.0-or-later
// Converts messages to and from bytes in one of the encodings (F6).
#pragma once

#include <string>
#include <string_view>

#include "base/result.hh"
#include "clients/nml/encoding.hh"
#include "clients/nml/message/vocabulary.hh"

namespace mw::nml {

/// Any thread. The vocabulary must outlive the codec and decoded messages.
class Codec {
  public:
    Codec(const Vocabulary &vocabulary, Encoding encoding) : vocabulary_(&vocabulary), encoding_(encoding) {}

    Encoding encoding() const { return encoding_; }

    /// Appends the message to `bytes`, which are unchanged after an error. The message is of the vocabulary,
    /// with the head of its base class.
    Result<> encode(const MessageView &message, std::string &bytes) const;

    /// Type of the message at the start of the bytes. An error if the vocabulary does not have it or declares
    /// it differently.
    Result<const MessageKind *> kind_of(std::string_view bytes) const;
    /// Reads exactly one message of this type. Every length is checked against the bytes and the declaration
    /// before memory is allocated. Ranges are not checked (messages::check). After an error the message may
    /// be partly written.
    Result<> decode(std::string_view bytes, const MessageView &message) const;
    /// Decodes a message of any type.
    Result<Message> decode(std::string_view bytes) const;

  private:
    const Vocabulary *vocabulary_;
    Encoding encoding_;
};

}  // namespace mw::nml
