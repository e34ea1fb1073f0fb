// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of hostmot2-serial.h. They belong to the component `hostmot2`, so that other components find
// them.
#include <algorithm>
#include <cerrno>
#include <string_view>

#include "drivers/mesa/hostmot2/hal/serial.hh"
#include "drivers/mesa/hostmot2/include/hostmot2-serial.h"
#include "drivers/mesa/hostmot2/modules/buffered_spi.hh"
#include "drivers/mesa/hostmot2/modules/packet_uart.hh"
#include "drivers/mesa/hostmot2/modules/uart.hh"

namespace {

using namespace mw::mesa;

/// Null if there is none with this name. [any thread, while no board is loaded or unloaded]
template <class Port>
Port *find(const std::vector<NamedPort<Port>> &all, const char *name) noexcept {
    const std::string_view wanted = name == nullptr ? "" : name;
    const auto found =
        std::ranges::find_if(all, [&](const NamedPort<Port> &port) { return port.name == wanted; });
    return found == all.end() ? nullptr : found->port;
}

Uart *uart_of(const char *name) noexcept {
    return find(known_ports().uarts, name);
}
PacketUart *packet_uart_of(const char *name) noexcept {
    return find(known_ports().packet_uarts, name);
}
BufferedSpi *spi_of(const char *name) noexcept {
    return find(known_ports().spis, name);
}

/// The result of a call on an interface, or -ENODEV.
template <class Port, class Call>
int with(Port *port, Call &&call) noexcept {
    return port == nullptr ? -ENODEV : static_cast<int>(call(*port));
}

constexpr int UART_READ_BYTES = 16;

}  // namespace

extern "C" {

MW_HOSTMOT2_API int hm2_uart_setup(const char *name, int bitrate, rtapi_s32 tx_mode, rtapi_s32 rx_mode) {
    return with(uart_of(name), [&](Uart &uart) {
        if (bitrate <= 0) {
            return -EINVAL;
        }
        uart.setup({static_cast<std::uint32_t>(bitrate), tx_mode, rx_mode});
        return 0;
    });
}

MW_HOSTMOT2_API int hm2_uart_send(const char *name, const unsigned char data[], int count) {
    return with(uart_of(name),
                [&](Uart &uart) { return uart.send({data, static_cast<std::size_t>(std::max(count, 0))}); });
}

MW_HOSTMOT2_API int hm2_uart_read(const char *name, unsigned char data[]) {
    return with(uart_of(name), [&](Uart &uart) { return uart.receive({data, UART_READ_BYTES}); });
}

MW_HOSTMOT2_API int hm2_pktuart_setup(const char *name, int bitrate, rtapi_s32 tx_mode, rtapi_s32 rx_mode,
                                      int txclear, int rxclear) {
    return with(packet_uart_of(name), [&](PacketUart &uart) {
        if (bitrate <= 0) {
            return -EINVAL;
        }
        uart.setup({static_cast<std::uint32_t>(bitrate), tx_mode, rx_mode, txclear != 0, rxclear != 0});
        return 0;
    });
}

MW_HOSTMOT2_API int hm2_pktuart_reset(const char *name) {
    return with(packet_uart_of(name), [](PacketUart &uart) {
        uart.reset();
        return 0;
    });
}

MW_HOSTMOT2_API int hm2_pktuart_send(const char *name, const unsigned char data[], rtapi_u8 *num_frames,
                                     const rtapi_u16 frame_sizes[]) {
    return with(packet_uart_of(name), [&](PacketUart &uart) {
        std::size_t bytes = 0;
        rtapi_u8 sent = 0;
        while (sent < *num_frames && uart.send({data + bytes, frame_sizes[sent]})) {
            bytes += frame_sizes[sent++];
        }
        const bool full = sent == 0 && *num_frames > 0;
        *num_frames = sent;
        return full ? -ENOSPC : static_cast<int>(bytes);
    });
}

MW_HOSTMOT2_API int hm2_pktuart_read(const char *name, unsigned char data[], rtapi_u8 *num_frames,
                                     rtapi_u16 *max_frame_length, rtapi_u16 frame_sizes[]) {
    return with(packet_uart_of(name), [&](PacketUart &uart) {
        const std::size_t most = *num_frames == 0 ? MAX_FRAMES : *num_frames;
        std::size_t bytes = 0;
        rtapi_u8 frames = 0;
        while (frames < most && !uart.frame_sizes().empty() && uart.frame_sizes()[0] <= *max_frame_length) {
            frame_sizes[frames] = uart.frame_sizes()[0];
            bytes += uart.receive({data + bytes, frame_sizes[frames]});
            ++frames;
        }
        *num_frames = frames;
        return bytes;
    });
}

MW_HOSTMOT2_API int hm2_pktuart_queue_get_frame_sizes(const char *name, rtapi_u32 fsizes[]) {
    return with(packet_uart_of(name), [&](PacketUart &uart) {
        const auto sizes = uart.frame_sizes();
        for (std::size_t i = 0; i < MAX_FRAMES; ++i) {
            fsizes[i] = i < sizes.size() ? sizes[i] : 0U;
        }
        return sizes.size();
    });
}

MW_HOSTMOT2_API int hm2_pktuart_queue_read_data(const char *name, rtapi_u32 *data, int bytes) {
    return with(packet_uart_of(name), [&](PacketUart &uart) {
        constexpr int BYTES_PER_WORD = 4;
        int done = 0;
        while (done < bytes && !uart.frame_sizes().empty()) {
            std::array<std::uint8_t, BYTES_PER_WORD> word{};
            const int wanted = std::min(bytes - done, BYTES_PER_WORD);
            done += static_cast<int>(uart.receive(std::span(word).first(static_cast<std::size_t>(wanted))));
            *data++ = word_of(word);
        }
        return done;
    });
}

MW_HOSTMOT2_API int hm2_pktuart_get_clock(const char *name) {
    return with(packet_uart_of(name), [](const PacketUart &uart) { return uart.clock_hz(); });
}
MW_HOSTMOT2_API int hm2_pktuart_get_version(const char *name) {
    return with(packet_uart_of(name), [](const PacketUart &uart) { return uart.version(); });
}
MW_HOSTMOT2_API rtapi_u32 hm2_pktuart_get_rx_status(const char *name) {
    const PacketUart *uart = packet_uart_of(name);
    return uart == nullptr ? 0U : uart->rx_status();
}
MW_HOSTMOT2_API rtapi_u32 hm2_pktuart_get_tx_status(const char *name) {
    const PacketUart *uart = packet_uart_of(name);
    return uart == nullptr ? 0U : uart->tx_status();
}

MW_HOSTMOT2_API int hm2_bspi_setup_chan(const char *name, int chan, int cs, int bits, double mhz, int delay,
                                        int cpol, int cpha, int noclear, int noecho, int samplelate) {
    return with(spi_of(name), [&](BufferedSpi &spi) {
        constexpr int MOST_SELECT = 15, MOST_BITS = 32;
        const bool usable = cs >= 0 && cs <= MOST_SELECT && bits >= 1 && bits <= MOST_BITS && mhz > 0.0;
        const SpiChannel channel{.chip_select = cs,
                                 .bits = bits,
                                 .mhz = mhz,
                                 .delay_ns = delay,
                                 .clock_high_idle = cpol != 0,
                                 .is_second_edge = cpha != 0,
                                 .sampled_late = samplelate != 0,
                                 .frame_kept = noclear != 0,
                                 .echo_off = noecho != 0};
        return usable && spi.setup_channel(chan, channel) ? 0 : -EINVAL;
    });
}

MW_HOSTMOT2_API int hm2_allocate_bspi_tram(const char *name) {
    return with(spi_of(name), [](BufferedSpi &) { return 0; });
}

MW_HOSTMOT2_API int hm2_tram_add_bspi_frame(const char *name, int chan, rtapi_u32 **wbuff,
                                            rtapi_u32 **rbuff) {
    return with(spi_of(name), [&](BufferedSpi &spi) {
        const BufferedSpi::Frame frame = spi.add_frame(chan);
        if (frame.sent == nullptr) {
            return -ENOSPC;
        }
        if (wbuff != nullptr) {
            *wbuff = frame.sent;
        }
        if (rbuff != nullptr) {
            *rbuff = frame.received;
        }
        return 0;
    });
}

MW_HOSTMOT2_API int hm2_bspi_write_chan(const char *name, int chan, rtapi_u32 val) {
    return with(spi_of(name), [&](BufferedSpi &spi) { return spi.write(chan, val) ? 0 : -ENOSPC; });
}

MW_HOSTMOT2_API int hm2_bspi_set_read_function(const char *name, int (*func)(void *subdata), void *subdata) {
    return with(spi_of(name), [&](BufferedSpi &spi) {
        spi.set_read(func, subdata);
        return 0;
    });
}

MW_HOSTMOT2_API int hm2_bspi_set_write_function(const char *name, int (*func)(void *subdata), void *subdata) {
    return with(spi_of(name), [&](BufferedSpi &spi) {
        spi.set_write(func, subdata);
        return 0;
    });
}

}  // extern "C"
