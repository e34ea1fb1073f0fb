// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/spi/spidev.hh"

#include <fcntl.h>
#include <linux/spi/spidev.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "drivers/mesa/spi/spi_codec.hh"

namespace mw::mesa::spi {

namespace {

constexpr std::uint8_t WORD_BITS = 32, BYTE_BITS = 8;

class Spidev final : public Device {
  public:
    Spidev(int file, ClockRates rates, std::uint8_t bits) : file_(file), rates_(rates), bits_(bits) {}
    ~Spidev() override { ::close(file_); }
    Spidev(const Spidev &) = delete;
    Spidev &operator=(const Spidev &) = delete;

    int transfer(std::span<std::uint32_t> words, Direction direction) noexcept override {
        if (bits_ == BYTE_BITS) {
            swap_bytes(words);
        }
        spi_ioc_transfer message{};
        message.tx_buf = reinterpret_cast<std::uintptr_t>(words.data());
        message.rx_buf = message.tx_buf;
        message.len = static_cast<std::uint32_t>(words.size_bytes());
        message.speed_hz = direction == Direction::READS ? rates_.read_hz : rates_.write_hz;
        message.bits_per_word = bits_;
        const int sent = ::ioctl(file_, SPI_IOC_MESSAGE(1), &message);
        const int error = sent < 0 ? errno : 0;
        if (bits_ == BYTE_BITS) {
            swap_bytes(words);
        }
        return sent >= 0 && sent != static_cast<int>(message.len) ? EIO : error;
    }

  private:
    int file_;
    ClockRates rates_;
    std::uint8_t bits_;
};

Error error_of(const std::string &path, const char *what) {
    return {.message = fmt::format("SPI device {}: cannot {}: {}.", path, what, std::strerror(errno)),
            .hint =
                "Check that the SPI bus is enabled, that the device exists, and that this user may open it."};
}

}  // namespace

Result<std::unique_ptr<Device>> open_spidev(const std::string &path, ClockRates rates) {
    const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) {
        return std::unexpected(error_of(path, "open it"));
    }
    std::uint8_t mode = SPI_MODE, is_lsb_first = 0, bits = WORD_BITS;
    std::uint32_t rate = rates.write_hz > rates.read_hz ? rates.write_hz : rates.read_hz;
    if (::ioctl(file, SPI_IOC_WR_BITS_PER_WORD, &bits) != 0) {
        bits = BYTE_BITS;
    }
    auto device = std::make_unique<Spidev>(file, rates, bits);
    if (::ioctl(file, SPI_IOC_WR_MODE, &mode) != 0) {
        return std::unexpected(error_of(path, "set SPI mode 0"));
    }
    if (::ioctl(file, SPI_IOC_WR_LSB_FIRST, &is_lsb_first) != 0) {
        return std::unexpected(error_of(path, "send the highest bit first"));
    }
    if (bits == BYTE_BITS && ::ioctl(file, SPI_IOC_WR_BITS_PER_WORD, &bits) != 0) {
        return std::unexpected(error_of(path, "set 8 or 32 bits"));
    }
    if (::ioctl(file, SPI_IOC_WR_MAX_SPEED_HZ, &rate) != 0) {
        return std::unexpected(error_of(path, "set the clock rate"));
    }
    return device;
}

std::string path_of_probe(unsigned bit) {
    constexpr const char *PATHS[] = {"/dev/spidev0.0", "/dev/spidev0.1", "/dev/spidev1.0", "/dev/spidev1.1",
                                     "/dev/spidev1.2"};
    for (std::size_t i = 0; i < std::size(PATHS); ++i) {
        if (bit == 1U << i) {
            return PATHS[i];
        }
    }
    return {};
}

}  // namespace mw::mesa::spi
