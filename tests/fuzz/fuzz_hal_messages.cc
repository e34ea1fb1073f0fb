// SPDX-License-Identifier: GPL-2.0-or-later
// Bytes from other processes: messages to the realtime process, records for halstreamer, periods of the
// command line.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "hal/host/message.hh"
#include "hal/tools/stream/record_text.hh"
#include "hal/tools/view/latency.hh"

namespace {

/// Decoded data are encoded to bytes that decode to the same data.
void check_messages(const std::string &bytes) {
    std::string buffer = bytes;
    mw::hal::Message message;
    while (true) {
        const auto isComplete = mw::hal::decode(buffer, message);
        if (!isComplete || !*isComplete) {
            return;
        }
        std::string again = mw::hal::encode(message);
        mw::hal::Message same;
        const auto isSame = mw::hal::decode(again, same);
        if (!isSame || !*isSame || same != message || !again.empty()) {
            std::abort();
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string text(reinterpret_cast<const char *>(data), size);
    check_messages(text);
    const std::vector<hal_type_t> types{HAL_BIT, HAL_FLOAT, HAL_S32, HAL_U32, HAL_S64, HAL_U64};
    const auto record = mw::hal::stream_tools::parse_record(types, text);
    if (record) {
        (void)mw::hal::stream_tools::format_record(types, record->data());
    }
    (void)mw::hal::view::parse_period(text);
    return 0;
}
