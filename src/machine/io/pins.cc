// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/io/pins.hh"

#include <algorithm>

namespace mw::io {

Result<> Pins::create(hal::Instance &hal) {
    const auto id = hal.components().create("iocontrol");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    Result<> status;
    pins_.make(hal, comp_id_, 0, status);
    if (status.has_value()) {
        status = hal.components().set_ready(comp_id_);
    }
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

void Pins::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->components().remove(comp_id_));
        hal_ = nullptr;
        block_ = nullptr;
    }
}

Result<> Pins::join_tool_offset() {
    const auto memory = hal_->memory().shared_block(ToolOffsetBlock::SHMEM_KEY, sizeof(ToolOffsetBlock));
    if (!memory.has_value()) {
        return std::unexpected(memory.error());
    }
    auto *const block = static_cast<ToolOffsetBlock *>(*memory);
    if (block->magic != ToolOffsetBlock::MAGIC) {
        return {};
    }
    if (block->layout_bytes != sizeof(ToolOffsetBlock)) {
        return fail("the motion controller that is loaded belongs to another version of Millwright");
    }
    block_ = block;
    return {};
}

Inputs Pins::read() {
    PinInputs inputs;
    pins_.read(inputs);
    inputs.in.tool_offset_shown =
        block_ == nullptr || block_->shown.load(std::memory_order_acquire) == sent_.number;
    return inputs.in;
}

void Pins::write(const Outputs &outputs) {
    pins_.write(PinOutputs{outputs});
    if (block_ != nullptr && (sent_.number == 0 || sent_.offset.c != outputs.tool_offset.c)) {
        sent_.number = std::max(sent_.number + 1, 1U);  // 0 means none
        sent_.offset = outputs.tool_offset;
        block_->latest.write(sent_);
    }
}

}  // namespace mw::io
