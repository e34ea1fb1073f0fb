// SPDX-License-Identifier: GPL-2.0-or-later
// Parameters of smart serial cards: values in HAL, and the steps that write one to its card in set-up.
// Source: shared/hardware.md, part B9.
#pragma once

#include <array>
#include <optional>

#include "drivers/mesa/hostmot2/modules/sserial_found.hh"
#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

/// A parameter, the value of its pin, and the bits in the card.
struct SserialParameter {
    std::string name;  ///< in lower case
    PinType type = PinType::U32;
    Access access = Access::RO;
    std::uint32_t u32 = 0;
    std::int32_t s32 = 0;
    double real = 0.0;
    int bits = 0;
    bool non_volatile = false;
    std::uint16_t address = 0;
    std::uint64_t known = 0;  ///< current bits in the card

    /// The field of the pin.
    void *field() noexcept;
    /// The value of the pin as bits of the card. [servo thread]
    std::uint64_t wanted() const noexcept;
    bool isChanged() const noexcept { return access == Access::RW && wanted() != known; }
};

/// The parameter of a card; empty if its type has no pin. [while loading]
std::optional<SserialParameter> make_parameter(const FoundParameter &found);

/// One exchange in set-up: values of the status and user registers of the channel.
struct SserialWriteStep {
    static constexpr int WORDS = 2;
    int number = 0;           ///< 0: none
    std::uint64_t value = 0;  ///< value being written
    std::uint32_t status = 0;
    std::array<std::uint32_t, WORDS> words{};
};
/// The step after `last`; number 0: the card has the value of `last`. Non-volatile memory is opened before a
/// write and closed after it. [servo thread]
SserialWriteStep next_step(const SserialParameter &parameter, const SserialWriteStep &last) noexcept;

}  // namespace mw::mesa
