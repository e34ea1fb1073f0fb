// SPDX-License-Identifier: GPL-2.0-or-later
// Messages to and from bytes in one of the encodings (F6).
#pragma once

#include <string>
#include <string_view>

#include "base/result.hh"
#include "clients/nml/encoding.hh"
#include "clients/nml/message/vocabulary.hh"

namespace mw::nml {

/// Any thread. The vocabulary must outlive it and what it decodes.
class Codec {
  public:
    Codec(const Vocabulary &vocabulary, Encoding encoding) : vocabulary_(&vocabulary), encoding_(encoding) {}

    Encoding encoding() const { return encoding_; }

    /// Appends to `bytes`; on an error they are as before. The message is of the vocabulary, with the head of
    /// its base class.
    Result<> encode(const MessageView &message, std::string &bytes) const;

    /// Which message the bytes begin with; an error when the vocabulary has none such or declares it
    /// otherwise.
    Result<const MessageKind *> kind_of(std::string_view bytes) const;
    /// Reads exactly one message of this kind. Every length is checked against the bytes and the declaration
    /// before memory is taken. Ranges are not checked (messages::check). On an error the message is partly
    /// written.
    Result<> decode(std::string_view bytes, const MessageView &message) const;
    /// A message of any kind.
    Result<Message> decode(std::string_view bytes) const;

  private:
    const Vocabulary *vocabulary_;
    Encoding encoding_;
};

}  // namespace mw::nml
