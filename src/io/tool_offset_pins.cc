// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/tool_offset_pins.hh"

#include "hal/api/millwright_ext.h"

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
    NumberedOffset latest;
    const bool isNew = block.latest.try_read(latest) && latest.number != current_.number;
    const std::uint32_t links = __atomic_load_n(links_, __ATOMIC_ACQUIRE);
    if (!isNew && links == last_links_) [[likely]] {
        return;
    }
    if (isNew) {
        current_ = latest;
    }
    last_links_ = links;
    for (int i = 0; i < MAX_AXES; ++i) {
        pins_[i].write(current_.offset[i]);
    }
    block.shown.store(current_.number, std::memory_order_release);
}

}  // namespace mw::io
