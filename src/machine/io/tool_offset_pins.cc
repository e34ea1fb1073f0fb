// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/io/tool_offset_pins.hh"

#include "hal/include/millwright_ext.h"

namespace mw::io {

int ToolOffsetPins::declare(int comp_id) noexcept {
    links_ = mw_ext_links();
    int status = 0;
    for (int i = 0; i < MAX_AXES && status == 0; ++i) {
        status = pins_[i].declare(comp_id, i);
    }
    return status;
}

void ToolOffsetPins::step(ToolOffsetBlock &block) noexcept {
    const std::uint32_t version = block.latest.version();
    const std::uint32_t links = __atomic_load_n(links_, __ATOMIC_ACQUIRE);
    if (version == last_version_ && links == last_links_) [[likely]] {
        return;
    }
    NumberedOffset latest;
    if (block.latest.try_read(latest)) {
        current_ = latest;
        last_version_ = version;
    }
    last_links_ = links;
    for (int i = 0; i < MAX_AXES; ++i) {
        pins_[i].write(current_.offset[i]);
    }
    block.shown.store(current_.number, std::memory_order_release);
}

}  // namespace mw::io
