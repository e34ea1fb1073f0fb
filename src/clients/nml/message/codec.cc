// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/message/codec.hh"

#include <fmt/format.h>

#include "clients/nml/message/binary_formats.hh"
#include "clients/nml/message/text_formats.hh"

namespace mw::nml {
namespace {

template <class Use>
auto with_writer(Encoding encoding, std::string &out, const Use &use) {
    switch (encoding) {
    case Encoding::RAW: {
        RawWriter writer(out);
        return use(writer);
    }
    case Encoding::XDR: {
        XdrWriter writer(out);
        return use(writer);
    }
    case Encoding::ASCII:
    case Encoding::DISPLAY: break;
    }
    TextWriter writer(encoding == Encoding::ASCII ? TextStyle::ASCII : TextStyle::DISPLAY, out);
    return use(writer);
}

template <class Use>
auto with_reader(Encoding encoding, std::string_view bytes, const Use &use) {
    switch (encoding) {
    case Encoding::RAW: {
        RawReader reader(bytes);
        return use(reader);
    }
    case Encoding::XDR: {
        XdrReader reader(bytes);
        return use(reader);
    }
    case Encoding::ASCII:
    case Encoding::DISPLAY: break;
    }
    TextReader reader(encoding == Encoding::ASCII ? TextStyle::ASCII : TextStyle::DISPLAY, bytes);
    return use(reader);
}

Result<const MessageKind *> read_kind(Format &format, const Vocabulary &vocabulary) {
    FrameHead head;
    if (!format.head(head)) {
        return fail(format.problem());
    }
    const MessageKind *kind = vocabulary.find(head.number);
    if (kind == nullptr) {
        return fail(fmt::format("there is no message {}", head.number));
    }
    const bool same_shape = kind->rejection != nullptr || head.shape == kind->shape;
    if (head.shape != 0 ? !same_shape : head.name != kind->name()) {
        return fail(fmt::format("the sender of message {} declares {} differently", head.number,
                                kind->declaration->name),
                    {}, "both sides must have the same version");
    }
    return kind;
}

/// For a message that is rejected in any case the fields are not read.
Result<> update_all(Format &format, const MessageKind &kind, const MessageView &message) {
    auto status = update(format, message.head);
    if (format.isReading() && kind.rejection != nullptr) {
        return status;
    }
    status = status.has_value() ? update(format, message.body) : status;
    if (status.has_value() && !format.end()) {
        return fail(fmt::format("{}: {}", message.body.declaration->name, format.problem()));
    }
    return status;
}

}  // namespace

Result<> Codec::encode(const MessageView &message, std::string &bytes) const {
    const MessageKind *kind = vocabulary_->find(message.body.declaration->number);
    if (kind == nullptr || kind->declaration != message.body.declaration) {
        return fail(fmt::format("{} is no message of this vocabulary", message.body.declaration->name));
    }
    if (message.head.declaration != kind->head()) {
        return fail(fmt::format("{} is a {} and has no {}", kind->declaration->name, name_of(kind->base),
                                message.head.declaration->name));
    }
    const std::size_t before = bytes.size();
    const auto status = with_writer(encoding_, bytes, [&](Format &format) {
        FrameHead head{kind->number, kind->shape, kind->name()};
        format.head(head);
        return update_all(format, *kind, message);
    });
    if (!status.has_value()) {
        bytes.resize(before);
    }
    return status;
}

Result<const MessageKind *> Codec::kind_of(std::string_view bytes) const {
    return with_reader(encoding_, bytes, [&](Format &format) { return read_kind(format, *vocabulary_); });
}

Result<> Codec::decode(std::string_view bytes, const MessageView &message) const {
    return with_reader(encoding_, bytes, [&](Format &format) -> Result<> {
        const auto kind = read_kind(format, *vocabulary_);
        if (!kind.has_value()) {
            return std::unexpected(kind.error());
        }
        if ((*kind)->declaration != message.body.declaration || (*kind)->head() != message.head.declaration) {
            return fail(fmt::format("message {} ({}) came where {} ({}) was expected",
                                    (*kind)->declaration->number, (*kind)->declaration->name,
                                    message.body.declaration->number, message.body.declaration->name));
        }
        return update_all(format, **kind, message);
    });
}

Result<Message> Codec::decode(std::string_view bytes) const {
    const auto kind = kind_of(bytes);
    if (!kind.has_value()) {
        return std::unexpected(kind.error());
    }
    Message message(**kind);
    const auto status = decode(bytes, message.view());
    return status.has_value() ? Result<Message>(std::move(message)) : std::unexpected(status.error());
}

}  // namespace mw::nml
