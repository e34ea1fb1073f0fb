// SPDX-License-Identifier: GPL-2.0-or-later
// Loading of the direct bus; these functions may allocate memory.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "drivers/mesa/direct/direct_bus.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

namespace {

/// Header, modules and pins of the largest description [registers].
constexpr std::uint16_t IDROM_REGISTERS = 272;
constexpr std::uint32_t SPACE_BYTES = 0x10000;

}  // namespace

Error DirectBus::error_of(const std::string &what) const {
    const int code = access_->last_error();
    return {.message = fmt::format("The board {} at {}: {} has failed{}.", card_.hal_name, place_, what,
                                   code == 0 ? "" : fmt::format(": {}", std::strerror(code))),
            .hint = "Check that the board has power and that its cable is connected."};
}

Result<std::unique_ptr<DirectBus>> DirectBus::open(std::unique_ptr<RegisterAccess> access, DirectCard card,
                                                   std::string place) {
    std::unique_ptr<DirectBus> bus(new DirectBus(std::move(access), std::move(card), std::move(place)));
    if (auto identified = bus->identify(); !identified) {
        return std::unexpected(identified.error());
    }
    return bus;
}

Result<> DirectBus::identify() {
    const auto cookie = read_now({.address = COOKIE_ADDRESS});
    if (!cookie) {
        return std::unexpected(cookie.error());
    }
    if ((*cookie)[0] != COOKIE) {
        return fail(
            fmt::format("The board {} at {} has no HostMot2 firmware: its cookie is {:#010x}, not {:#010x}.",
                        card_.hal_name, place_, (*cookie)[0], COOKIE),
            {}, "Write a firmware to the board with mesaflash. Firmware is not loaded by this driver.");
    }
    const auto offset = read_now({.address = IDROM_OFFSET_ADDRESS});
    if (!offset) {
        return std::unexpected(offset.error());
    }
    if ((*offset)[0] % 4 != 0 || (*offset)[0] > SPACE_BYTES - 4 * IDROM_REGISTERS) {
        return fail(fmt::format(
            "The firmware of the board {} at {} has its description at {:#x}, outside the registers.",
            card_.hal_name, place_, (*offset)[0]));
    }
    idrom_address_ = static_cast<std::uint16_t>((*offset)[0]);
    auto identity = read_now({.address = idrom_address_, .count = IDROM_REGISTERS});
    if (!identity) {
        return std::unexpected(identity.error());
    }
    identity_ = std::move(*identity);
    return set_lists({}, 0);
}

Result<std::vector<std::uint32_t>> DirectBus::read_now(RegisterRange range) {
    std::vector<std::uint32_t> values(range.count, 0);
    if (!access_->read(range.address, values)) {
        return std::unexpected(error_of(fmt::format("the read of register {:#06x}", range.address)));
    }
    return values;
}

Result<> DirectBus::write_now(std::uint16_t address, std::span<const std::uint32_t> values) {
    if (!access_->write(address, values)) {
        return std::unexpected(error_of(fmt::format("the write of register {:#06x}", address)));
    }
    return {};
}

Result<> DirectBus::set_lists(std::span<const RegisterRange> reads, int max_writes) {
    ranges_.assign(1, {.address = COOKIE_ADDRESS});
    ranges_.insert(ranges_.end(), reads.begin(), reads.end());
    std::size_t count = 0;
    for (const RegisterRange &range : ranges_) {
        count += range.count;
    }
    values_.assign(count, 0);
    return access_->prepare(ranges_, max_writes);
}

}  // namespace mw::mesa
