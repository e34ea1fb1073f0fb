// SPDX-License-Identifier: GPL-2.0-or-later
// Buffered SPI of a board (BSPI): up to 16 devices at one interface, each with a descriptor. A component
// registers words that are exchanged in each cycle, or writes single words. Registers: Mesa's register map.
// Only the thread of the board may call the functions, unless their comment states otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace mw::mesa {

constexpr std::size_t SPI_CHANNELS = 16, SPI_WORDS = 16;

/// A device at the interface.
struct SpiChannel {
    int chip_select = 0, bits = 8;  ///< 0 to 15, 1 to 32
    double mhz = 1.0;
    int delay_ns = 0;  ///< between chip select and clock
    bool clock_high_idle = false, is_second_edge = false, sampled_late = false;
    bool frame_kept = false;  ///< chip select remains active after the word
    bool echo_off = false;    ///< the answer of the device is not stored
};
/// The descriptor of a channel. The clock is the maximum that does not exceed `mhz`.
std::uint32_t spi_descriptor(const SpiChannel &channel, std::uint32_t clock_hz) noexcept;

class BufferedSpi {
  public:
    /// A word that is exchanged in each cycle.
    struct Frame {
        int channel = 0;
        std::uint32_t *sent = nullptr, *received = nullptr;
    };
    using Callback = int (*)(void *);

    /// Applies a descriptor with the next write; false: there is no such channel. [any time]
    bool setup_channel(int channel, const SpiChannel &settings) noexcept;
    /// Queues one word for the next write; false: 16 are queued, or there is no such channel.
    bool write(int channel, std::uint32_t value) noexcept;
    /// Registers a word of each cycle and returns its buffers; a Frame without buffers when there are 16
    /// already. [loading]
    Frame add_frame(int channel) noexcept;
    /// `call` is called after the words of a cycle were received. [loading]
    void set_read(Callback call, void *data) noexcept { on_read_ = {call, data}; }
    /// `call` is called before the words of a cycle are sent. [loading]
    void set_write(Callback call, void *data) noexcept { on_write_ = {call, data}; }

    /// --- for the module of the board
    bool take_setup() noexcept;
    std::uint32_t descriptor(std::size_t channel, std::uint32_t clock_hz) const noexcept {
        return spi_descriptor(channels_[channel], clock_hz);
    }
    bool hasEcho(int channel) const noexcept {
        return !channels_[static_cast<std::size_t>(channel)].echo_off;
    }
    std::span<const Frame> frames() const noexcept { return {frames_.data(), frame_count_}; }
    /// Queued words; removed after they are read.
    struct Word {
        int channel = 0;
        std::uint32_t value = 0;
    };
    std::span<const Word> take_words() noexcept;
    void call_read() const noexcept { on_read_(); }
    void call_write() const noexcept { on_write_(); }

  private:
    struct Call {
        Callback call = nullptr;
        void *data = nullptr;
        void operator()() const noexcept {
            if (call != nullptr) {
                (void)call(data);
            }
        }
    };
    std::array<SpiChannel, SPI_CHANNELS> channels_{};
    bool setup_due_ = false;
    std::array<Frame, SPI_WORDS> frames_{};
    std::array<std::uint32_t, SPI_WORDS> sent_{}, received_{};
    std::size_t frame_count_ = 0;
    std::array<Word, SPI_WORDS> words_{};
    std::size_t word_count_ = 0;
    Call on_read_, on_write_;
};

}  // namespace mw::mesa
