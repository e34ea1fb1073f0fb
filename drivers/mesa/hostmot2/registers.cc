// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/registers.hh"

#include <algorithm>
#include <numeric>

namespace mw::mesa {

ReadHandle Registers::read(RegisterRange range, ReadOrder order) {
    reads_.push_back({range, order, 0, 0});
    return {static_cast<int>(reads_.size()) - 1};
}

WriteHandle Registers::write(std::uint16_t address, WriteOrder order, Send send, std::uint32_t value) {
    Write write;
    write.address = address;
    write.order = order;
    write.send = send;
    write.value = value;
    writes_.push_back(write);
    return {static_cast<int>(writes_.size()) - 1};
}

Result<> Registers::fix(RegisterBus &bus) {
    std::vector<std::size_t> order(reads_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return reads_[i].order; });
    bus_ = &bus;
    ranges_.clear();
    int words = 0;
    for (const std::size_t i : order) {
        reads_[i].position = static_cast<int>(ranges_.size());
        ranges_.push_back(reads_[i].range);
        reads_[i].first = words;
        words += reads_[i].range.count;
    }
    inputs_.assign(static_cast<std::size_t>(words), 0);
    sequence_.resize(writes_.size());
    std::iota(sequence_.begin(), sequence_.end(), std::uint16_t{0});
    std::ranges::stable_sort(sequence_, {}, [&](std::uint16_t i) { return writes_[i].order; });
    list_.reserve(writes_.size());
    return bus.set_lists(ranges_, static_cast<int>(writes_.size()));
}

bool Registers::redirect(ReadHandle handle, std::uint16_t address) noexcept {
    return bus_->redirect(reads_[static_cast<std::size_t>(handle.index)].position, address);
}

bool Registers::isDue(const Write &write, bool all) noexcept {
    switch (write.send) {
    case Send::ALWAYS: return true;
    case Send::CHANGED: return all || !write.is_written || write.value != write.written;
    case Send::AFTER_FAULT: return all;
    case Send::REPEATED: return write.requested || (all && write.ever_requested);
    case Send::REQUESTED: break;
    }
    return write.requested;
}

std::span<const RegisterWrite> Registers::list(bool all) noexcept {
    list_.clear();
    for (const std::uint16_t i : sequence_) {
        Write &write = writes_[i];
        if (isDue(write, all)) {
            list_.push_back({write.address, write.value});  // within the capacity
            write.written = write.value;
            write.is_written = true;
        }
        write.requested = false;
    }
    return list_;
}

}  // namespace mw::mesa
