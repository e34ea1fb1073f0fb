// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/uart.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { DATA, COUNT, RATE, MODE };
constexpr std::size_t UART_FIFO_BYTES = 16;
constexpr std::size_t PACKET_FIFO_WORDS = 1024;
constexpr std::size_t MAX_FRAMES = 16, BYTES_IN_WORD = 4;
constexpr std::uint32_t CLEAR = 0x80010000, FRAMES_SHIFT = 16, FRAMES_MASK = 0x1FU << FRAMES_SHIFT;

std::uint8_t byte_of(std::uint32_t value, unsigned index) {
    return static_cast<std::uint8_t>((value >> (8 * index)) & 0xFFU);
}

}  // namespace

void UartModule::take(unsigned instance) {
    Port &port = ports_[instance];
    while (const auto bytes = (*lines_)[instance].receive(time_ns_)) {
        for (const std::uint8_t byte : *bytes) {
            if (port.received.size() < UART_FIFO_BYTES) {
                port.received.push_back(byte);
            }
        }
    }
}

std::uint32_t UartModule::read(RegisterPlace place) {
    Port &port = ports_[place.instance];
    if (place.reg == RATE || place.reg == MODE) {
        return place.reg == RATE ? port.rate : port.mode;
    }
    if (role_ == UartRole::TRANSMIT) {
        return place.reg == COUNT ? (*lines_)[place.instance].pending(time_ns_) : 0;
    }
    take(place.instance);
    if (place.reg == COUNT) {
        return static_cast<std::uint32_t>(port.received.size());
    }
    std::uint32_t value = 0;
    for (unsigned i = 0; i <= place.word && !port.received.empty(); ++i) {
        value |= std::uint32_t{port.received.front()} << (8 * i);
        port.received.pop_front();
    }
    return value;
}

void UartModule::write(RegisterPlace place, std::uint32_t value) {
    Port &port = ports_[place.instance];
    switch (place.reg) {
    case DATA:
        for (unsigned i = 0; role_ == UartRole::TRANSMIT && i <= place.word; ++i) {
            (*lines_)[place.instance].send({byte_of(value, i)}, time_ns_, bits_per_s(port.rate, clock_hz_));
        }
        break;
    case COUNT:
        take(place.instance);
        port.received.clear();
        break;
    case RATE: port.rate = value; break;
    default: port.mode = value; break;
    }
}

void PacketUartModule::take(unsigned instance) {
    Port &port = ports_[instance];
    while (const auto bytes = (*lines_)[instance].receive(time_ns_)) {
        if (port.sizes.size() == MAX_FRAMES) {
            continue;  // If the FIFO is full, the frame is lost.
        }
        port.sizes.push_back(static_cast<std::uint32_t>(bytes->size()));
        for (std::size_t i = 0; i < bytes->size(); i += BYTES_IN_WORD) {
            std::uint32_t word = 0;
            for (unsigned k = 0; k < BYTES_IN_WORD && i + k < bytes->size(); ++k) {
                word |= std::uint32_t{(*bytes)[i + k]} << (8 * k);
            }
            port.words.push_back(word);
        }
    }
}

void PacketUartModule::send_frame(unsigned instance, std::uint32_t bytes) {
    Port &port = ports_[instance];
    SerialBytes frame;
    while (frame.size() < bytes && !port.words.empty()) {
        for (unsigned k = 0; k < BYTES_IN_WORD && frame.size() < bytes; ++k) {
            frame.push_back(byte_of(port.words.front(), k));
        }
        port.words.pop_front();
    }
    (*lines_)[instance].send(frame, time_ns_, bits_per_s(port.rate, clock_hz_));
}

std::uint32_t PacketUartModule::read(RegisterPlace place) {
    Port &port = ports_[place.instance];
    const auto pop = [](std::deque<std::uint32_t> &fifo) {
        const std::uint32_t value = fifo.empty() ? 0 : fifo.front();
        if (!fifo.empty()) {
            fifo.pop_front();
        }
        return value;
    };
    const bool receives = role_ == UartRole::RECEIVE;
    if (receives) {
        take(place.instance);
    }
    switch (place.reg) {
    case DATA: return receives ? pop(port.words) : 0;
    case COUNT: return receives ? pop(port.sizes) : 0;
    case RATE: return port.rate;
    default: {
        const auto frames = receives ? static_cast<std::uint32_t>(port.sizes.size())
                                     : (*lines_)[place.instance].pending(time_ns_);
        return (port.mode & ~FRAMES_MASK) | ((frames << FRAMES_SHIFT) & FRAMES_MASK);
    }
    }
}

void PacketUartModule::write(RegisterPlace place, std::uint32_t value) {
    Port &port = ports_[place.instance];
    const bool transmits = role_ == UartRole::TRANSMIT;
    switch (place.reg) {
    case DATA:
        if (transmits && port.words.size() < PACKET_FIFO_WORDS) {
            port.words.push_back(value);
        }
        break;
    case COUNT:
        if (transmits) {
            send_frame(place.instance, value);
        }
        break;
    case RATE: port.rate = value; break;
    default:
        if ((value & CLEAR) == CLEAR) {
            if (!transmits) {
                take(place.instance);
            }
            port.words.clear();
            port.sizes.clear();
        } else {
            port.mode = value;
        }
        break;
    }
}

}  // namespace mw::mesa::board
