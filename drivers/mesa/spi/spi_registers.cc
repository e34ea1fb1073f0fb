// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/spi/spi_registers.hh"

#include <algorithm>
#include <cerrno>

#include "drivers/mesa/spi/spi_codec.hh"

namespace mw::mesa::spi {

bool SpiRegisters::append(std::uint32_t word) noexcept {
    if (used_ == words_.size()) {
        last_error_ = EMSGSIZE;
        return false;
    }
    words_[used_] = word;
    ++used_;
    return true;
}

bool SpiRegisters::transfer(Direction direction) noexcept {
    last_error_ = device_->transfer(std::span(words_).first(used_), direction);
    used_ = 0;
    return last_error_ == 0;
}

bool SpiRegisters::read(std::uint16_t address, std::span<std::uint32_t> values) noexcept {
    const RegisterRange range{.address = address, .count = static_cast<std::uint16_t>(values.size())};
    return read_list({&range, 1}, values);
}

bool SpiRegisters::read_list(std::span<const RegisterRange> ranges,
                             std::span<std::uint32_t> values) noexcept {
    used_ = 0;
    bool fits = true;
    for (const RegisterRange &range : ranges) {
        for (int from = 0; from < range.count; from += MOST_IN_COMMAND) {
            const int count = std::min(range.count - from, MOST_IN_COMMAND);
            fits = fits && append(command_word(Access::READ,
                                               static_cast<std::uint16_t>(range.address + 4 * from), count));
            for (int i = 0; i < count; ++i) {
                fits = fits && append(0);
            }
        }
    }
    if (!fits || !transfer(Direction::READS)) {
        return false;
    }
    // Received data are at the positions of the data words.
    std::size_t at = 0, value = 0;
    for (const RegisterRange &range : ranges) {
        for (int i = 0; i < range.count; ++i) {
            at += i % MOST_IN_COMMAND == 0 ? 1U : 0U;
            values[value] = words_[at];
            ++value;
            ++at;
        }
    }
    return true;
}

bool SpiRegisters::write(std::uint16_t address, std::span<const std::uint32_t> values) noexcept {
    used_ = 0;
    bool fits = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i % MOST_IN_COMMAND == 0) {
            const auto count = static_cast<int>(std::min<std::size_t>(values.size() - i, MOST_IN_COMMAND));
            fits = fits &&
                   append(command_word(Access::WRITE, static_cast<std::uint16_t>(address + 4 * i), count));
        }
        fits = fits && append(values[i]);
    }
    return fits && transfer(Direction::WRITES);
}

bool SpiRegisters::write_list(std::span<const RegisterWrite> writes) noexcept {
    used_ = 0;
    bool fits = true;
    while (!writes.empty()) {
        const std::size_t count = consecutive_writes(writes, MOST_IN_COMMAND);
        fits = fits && append(command_word(Access::WRITE, writes[0].address, static_cast<int>(count)));
        for (std::size_t i = 0; i < count; ++i) {
            fits = fits && append(writes[i].value);
        }
        writes = writes.subspan(count);
    }
    return fits && (used_ == 0 || transfer(Direction::WRITES));
}

}  // namespace mw::mesa::spi
