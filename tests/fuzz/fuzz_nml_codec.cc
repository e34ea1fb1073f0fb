// SPDX-License-Identifier: GPL-2.0-or-later
// Every decoder of NML messages, selected by the first byte. An accepted message is reproduced unchanged.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "clients/nml/message/codec.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    static const mw::nml::Vocabulary VOCABULARY = mw::nml::Vocabulary::standard();
    if (size == 0) {
        return 0;
    }
    const std::string_view bytes(reinterpret_cast<const char *>(data) + 1, size - 1);
    const mw::nml::Codec codec(VOCABULARY, mw::nml::ALL_ENCODINGS[data[0] % mw::nml::ALL_ENCODINGS.size()]);
    auto message = codec.decode(bytes);
    if (!message.has_value()) {
        return 0;
    }
    std::string first, second;
    if (!codec.encode(message->view(), first).has_value()) {
        std::abort();
    }
    auto again = codec.decode(first);
    if (!again.has_value() || !codec.encode(again->view(), second).has_value() || first != second) {
        std::abort();
    }
    return 0;
}
