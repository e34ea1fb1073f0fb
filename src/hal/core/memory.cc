// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/memory.hh"

#include <cerrno>
#include <cstring>
#include <string>

#include "hal/core/detail/names.hh"
#include "hal/core/detail/segment.hh"

namespace mw::hal {

using namespace detail;

namespace {

Result<> give_memory(Segment &segment, BlockRecord &block, std::size_t bytes) {
    if (block.room < bytes) {
        const Offset memory = segment.allocate(bytes, 64);
        if (memory == 0) {
            return refuse(ENOMEM, fmt::format("shared block {}: no memory for {} bytes", block.key, bytes));
        }
        block.memory = memory;
        block.room = bytes;
    } else if (block.users == 0) {
        std::memset(segment.at<void>(block.memory), 0, bytes);
    }
    return {};
}

}  // namespace

void *Memory::allocate(std::size_t bytes) {
    Guard guard(segment_);
    return segment_.at<void>(segment_.allocate(bytes));
}

void *Memory::at(Reference reference) const noexcept {
    return segment_.at<void>(reference);
}

void *Memory::checked_at(std::int64_t reference, std::size_t bytes) const noexcept {
    if (reference <= 0 || reference > static_cast<std::int64_t>(RESERVE)) {
        return nullptr;
    }
    void *address = at(static_cast<Reference>(reference));
    return contains(address, bytes) ? address : nullptr;
}

Reference Memory::reference_of(const volatile void *address) const noexcept {
    return segment_.offset_of(const_cast<const void *>(address));
}

bool Memory::contains(const void *address, std::size_t bytes) const noexcept {
    return segment_.contains(address, bytes);
}

Result<SharedBlock> Memory::open_block(int key, std::size_t bytes) {
    Guard guard(segment_);
    const std::string name = std::to_string(key);
    auto *block = segment_.find_as<BlockRecord>(Kind::BLOCK, name);
    const bool is_new = block == nullptr;
    if (is_new) {
        block = segment_.make<BlockRecord>(Kind::BLOCK, name);
        if (block == nullptr) {
            return refuse(ENOMEM, fmt::format("shared block {}: no HAL memory left", key));
        }
        block->key = key;
    }
    if (bytes == 0 || (block->users > 0 && block->size < bytes)) {
        return refuse(EINVAL,
                      fmt::format("shared block {} has {} bytes, expected {}", key, block->size, bytes));
    }
    if (auto given = give_memory(segment_, *block, bytes); !given) {
        return std::unexpected(given.error());
    }
    block->size = block->users == 0 ? bytes : block->size;
    ++block->users;
    if (is_new) {
        segment_.insert(Kind::BLOCK, *block);
    }
    return SharedBlock{static_cast<int>(segment_.offset_of(block)), block->memory};
}

Result<void *> Memory::shared_block(int key, std::size_t bytes) {
    const auto block = open_block(key, bytes);
    if (!block) {
        return std::unexpected(block.error());
    }
    return at(block->memory);
}

void *Memory::block_memory(int id) const noexcept {
    return at(segment_.at<BlockRecord>(static_cast<Offset>(id))->memory);
}

bool Memory::close_block(int id) {
    Guard guard(segment_);
    auto *block = segment_.at<BlockRecord>(static_cast<Offset>(id));
    if (id <= 0 || block->users == 0) {
        return false;
    }
    --block->users;
    return true;
}

bool Memory::close_block_at(Reference memory) {
    Guard guard(segment_);
    bool closed = false;
    segment_.each<BlockRecord>(Kind::BLOCK, [&](BlockRecord &block) {
        if (memory != 0 && block.memory == memory && block.users > 0) {
            --block.users;
            closed = true;
        }
    });
    return closed;
}

void Memory::repair() {
    Guard guard(segment_);
}

MemoryStatistics Memory::statistics() const {
    Guard guard(segment_);
    const auto count = [&](Kind kind) {
        RecordCount records{static_cast<int>(segment_.table(kind).count), 0};
        for (Offset at = segment_.table(kind).free; at != 0; at = segment_.at<Record>(at)->next) {
            ++records.recycled;
        }
        return records;
    };
    MemoryStatistics statistics;
    statistics.segment_bytes = segment_.header().top;
    statistics.capacity_bytes = RESERVE;
    statistics.components = count(Kind::COMP);
    statistics.pins = count(Kind::PIN);
    const RecordCount pin_aliases = count(Kind::PIN_ALIAS);
    const RecordCount param_aliases = count(Kind::PARAM_ALIAS);
    statistics.aliases = {pin_aliases.active + param_aliases.active,
                          pin_aliases.recycled + param_aliases.recycled};
    statistics.signals = count(Kind::SIGNAL);
    statistics.params = count(Kind::PARAM);
    statistics.functs = count(Kind::FUNCT);
    statistics.threads = count(Kind::THREAD);
    return statistics;
}

}  // namespace mw::hal
