// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>
#include <deque>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/modules/absolute.hh"
#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/field_format.hh"

namespace mw::mesa {

namespace {

/// Differences between the types. Registers are numbered from the base address of the module.
struct Type {
    Gtag gtag;
    const char *name;
    int most_bits;
    double khz;
    int control, setup, start;  ///< registers; the last one is for all channels
    bool lifo;                  ///< all words are read from the first data register
};
constexpr Type TYPES[] = {
    {Gtag::SSI, "ssi", 64, 500.0, 2, 2, 3, false},
    {Gtag::BISS, "biss", 96, 500.0, 2, 1, 3, true},
    {Gtag::FANUC_ABSOLUTE, "fanuc", 76, 1024.0, 3, 4, 5, false},
};
constexpr std::size_t MAX_WORDS = 3;
constexpr int BITS_PER_WORD = 32;
constexpr int FANUC_LENGTH = 2;  // register

/// Values of one field.
struct FieldPins {
    BitField field, high;  ///< `high` is the upper part of an encoder in two parts, else 0 bits
    bool set = false, not_set = true;
    double value = 0.0, scale_max = 1.0;
    std::array<bool, MAX_FIELD_BITS> bits{}, bits_not{};
    AbsoluteEncoder encoder;
};

void show_bits(FieldPins &pins, std::uint64_t value) noexcept {
    for (std::size_t i = 0; i < pins.bits.size(); ++i) {
        pins.bits[i] = ((value >> i) & 1U) != 0;
        pins.bits_not[i] = !pins.bits[i];
    }
}

double full_scale(int bits) noexcept {
    return static_cast<double>(bits >= MAX_FIELD_BITS ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1);
}

void show(FieldPins &pins, std::span<const std::uint32_t> words) noexcept {
    const BitField &field = pins.field;
    std::uint64_t value = bits_of(field, words);
    switch (field.type) {
    case BitFieldType::PADDING: break;
    case BitFieldType::BIT:
        pins.set = value != 0;
        pins.not_set = !pins.set;
        break;
    case BitFieldType::UNSIGNED:
        pins.value = static_cast<double>(value) / full_scale(field.bits) * pins.scale_max;
        break;
    case BitFieldType::SIGNED:
        pins.value = static_cast<double>(signed_bits(value, field.bits)) /
                     (full_scale(field.bits - 1) + 1.0) * pins.scale_max;
        break;
    case BitFieldType::BITS: show_bits(pins, value); break;
    case BitFieldType::ENCODER:
    case BitFieldType::ENCODER_LOW:
    case BitFieldType::ENCODER_HIGH: {
        BitField whole = field;
        if (pins.high.bits > 0) {
            value |= bits_of(pins.high, words) << static_cast<unsigned>(field.bits);
            whole.bits += pins.high.bits;
            whole.multi_turn = field.multi_turn || pins.high.multi_turn;
        }
        absolute_encoder_read(pins.encoder, value, whole);
        break;
    }
    }
}

class AbsoluteEncoders final : public Module {
  public:
    AbsoluteEncoders(const ModuleRequest &request, const Type &type)
        : module_(request.module), type_(type),
          clocks_{request.idrom.header.clock_low_hz, request.idrom.header.clock_high_hz},
          formats_(*request.config.formats_of(type.gtag)), has_timer_(hasDpll(request.assignment)) {}

    Result<> prepare(RegisterBus &) override {
        for (const auto &[number, format] : formats_) {
            auto fields = parse_field_format(format, type_.most_bits);
            if (!fields) {
                return fail(
                    fmt::format("config: {}_chan_{}: {}", type_.name, number, fields.error().message));
            }
            Channel &channel = channels_.emplace_back();
            channel.number = number;
            channel.khz = type_.khz;
            channel.timer = has_timer_ ? 1 : 0;
            channel.bits = fields->empty() ? 0 : fields->back().field.first + fields->back().field.bits;
            add_fields(channel, *fields);
        }
        return {};
    }
    /// The driver counts the revolutions of an encoder that does not count them.
    bool isCounting() const noexcept override { return !channels_.empty(); }
    void plan(Registers &registers) override {
        // The busy register is read before the data, because reading these marks them as old.
        busy_ = registers.read({module_.address(type_.start), 1}, ReadOrder::INPUT);
        for (Channel &channel : channels_) {
            const int number = channel.number;
            channel.words = (channel.bits + BITS_PER_WORD - 1) / BITS_PER_WORD;
            // The third word of a Fanuc encoder also contains the cable error.
            channel.words = type_.gtag == Gtag::FANUC_ABSOLUTE ? int{MAX_WORDS} : channel.words;
            for (int i = 0; i < channel.words; ++i) {
                const std::uint16_t address = module_.address(type_.lifo ? 0 : i, number);
                channel.data[static_cast<std::size_t>(i)] = registers.read({address, 1}, ReadOrder::INPUT);
            }
            const auto add = [&](int reg, Send send) {
                return registers.write(module_.address(reg, number), WriteOrder::CONFIGURATION, send);
            };
            if (type_.gtag == Gtag::FANUC_ABSOLUTE) {
                channel.open = add(type_.control, Send::REPEATED);
                channel.length = add(FANUC_LENGTH, Send::REPEATED);
            }
            channel.setup = add(type_.setup, Send::REPEATED);
            channel.control = add(type_.control, Send::REPEATED);
        }
        start_ = registers.write(module_.address(type_.start), WriteOrder::RATE, Send::REQUESTED);
    }
    void declare(PinSpace &space) override {
        for (Channel &channel : channels_) {
            const std::string name = fmt::format("{}.{:02}", type_.name, channel.number);
            binding_.add(space, name + ".data-invalid", PinType::BIT, Access::OUT, &channel.invalid);
            binding_.add(space, name + ".data-incomplete", PinType::BIT, Access::OUT, &channel.incomplete);
            binding_.add(space, name + ".frequency-khz", PinType::FLOAT, Access::RW, &channel.khz);
            binding_.add(space, name + ".timer-number", PinType::U32, Access::RW, &channel.timer);
            if (type_.gtag == Gtag::FANUC_ABSOLUTE) {
                binding_.add(space, name + ".filter", PinType::U32, Access::RW, &channel.filter);
            }
            for (auto &[field_name, pins] : channel.fields) {
                declare_field(space, name + "." + field_name, pins);
            }
        }
    }
    void read(const Registers &registers, const Cycle &) noexcept override {
        binding_.load();
        const std::uint32_t busy = registers.value(busy_);
        for (Channel &channel : channels_) {
            std::array<std::uint32_t, MAX_WORDS> words{};
            for (int i = 0; i < channel.words; ++i) {
                words[static_cast<std::size_t>(i)] =
                    registers.value(channel.data[static_cast<std::size_t>(i)]);
            }
            channel.incomplete = ((busy >> static_cast<unsigned>(channel.number)) & 1U) != 0;
            channel.invalid = channel.incomplete || hasCableError(words);
            for (auto &[name, pins] : channel.fields) {
                if (!channel.invalid) {
                    show(pins, words);
                }
            }
        }
        binding_.store();
    }
    void write(Registers &registers, const Cycle &cycle) noexcept override {
        binding_.load();
        for (Channel &channel : channels_) {
            constexpr std::uint32_t LAST_TIMER = 4;
            channel.timer = std::min(channel.timer, LAST_TIMER);
            const bool changed = channel.khz != channel.sent_khz || channel.timer != channel.sent_timer ||
                                 channel.filter != channel.sent_filter || !channel.sent;
            if (changed && cycle.writing) {
                send_setup(registers, channel);
            }
        }
        if (triggered_ && cycle.writing) {
            registers.request(start_, 1);
            triggered_ = false;
        }
        binding_.store();
    }
    bool hasTrigger() const noexcept override { return !has_timer_; }
    void trigger() noexcept override { triggered_ = true; }

  private:
    struct Channel {
        int number = 0, bits = 0, words = 0;
        double khz = 0.0, sent_khz = 0.0;
        std::uint32_t timer = 0, filter = 15, sent_timer = 0, sent_filter = 0;
        bool sent = false, incomplete = false, invalid = false;
        std::deque<std::pair<std::string, FieldPins>> fields;
        std::array<ReadHandle, MAX_WORDS> data;
        WriteHandle open, length, setup, control;
    };

    /// An encoder in two parts becomes one field.
    static void add_fields(Channel &channel, const std::vector<NamedField> &fields) {
        const auto high = std::ranges::find_if(
            fields, [](const NamedField &named) { return named.field.type == BitFieldType::ENCODER_HIGH; });
        for (const auto &[name, field] : fields) {
            if (field.type == BitFieldType::PADDING || field.type == BitFieldType::ENCODER_HIGH) {
                continue;
            }
            FieldPins pins;
            pins.field = field;
            if (field.type == BitFieldType::ENCODER_LOW && high != fields.end()) {
                pins.high = high->field;
            }
            channel.fields.emplace_back(name, pins);
        }
    }
    void declare_field(PinSpace &space, const std::string &name, FieldPins &pins) {
        const auto add = [&](const std::string &pin, PinType type, Access access, void *value) {
            binding_.add(space, pin, type, access, value);
        };
        switch (pins.field.type) {
        case BitFieldType::BIT:
            add(name, PinType::BIT, Access::OUT, &pins.set);
            add(name + "-not", PinType::BIT, Access::OUT, &pins.not_set);
            break;
        case BitFieldType::UNSIGNED:
        case BitFieldType::SIGNED:
            add(name, PinType::FLOAT, Access::OUT, &pins.value);
            add(name + "-scalemax", PinType::FLOAT, Access::RW, &pins.scale_max);
            break;
        case BitFieldType::BITS:
            for (int i = 0; i < pins.field.bits; ++i) {
                const std::string bit = fmt::format("{}-{:02}", name, i);
                add(bit, PinType::BIT, Access::OUT, &pins.bits[static_cast<std::size_t>(i)]);
                add(bit + "-not", PinType::BIT, Access::OUT, &pins.bits_not[static_cast<std::size_t>(i)]);
            }
            break;
        default: declare_encoder(space, name, pins.encoder); break;
        }
    }
    void declare_encoder(PinSpace &space, const std::string &name, AbsoluteEncoder &encoder) {
        binding_.add(space, name + ".count", PinType::S32, Access::OUT, &encoder.count);
        binding_.add(space, name + ".rawcounts", PinType::S32, Access::OUT, &encoder.rawcounts);
        binding_.add(space, name + ".position", PinType::FLOAT, Access::OUT, &encoder.position);
        binding_.add(space, name + ".index-enable", PinType::BIT, Access::IO, &encoder.index_enable);
        binding_.add(space, name + ".reset", PinType::BIT, Access::IO, &encoder.reset);
        binding_.add(space, name + ".scale", PinType::FLOAT, Access::RW, &encoder.scale);
        binding_.add(space, name + ".counts-per-rev", PinType::U32, Access::RW, &encoder.counts_per_rev);
    }
    bool hasCableError(std::span<const std::uint32_t> words) const noexcept {
        constexpr std::uint32_t CABLE_ERROR = 1U << 31U;
        return type_.gtag == Gtag::FANUC_ABSOLUTE && (words[FANUC_LENGTH] & CABLE_ERROR) != 0;
    }
    void send_setup(Registers &registers, Channel &channel) const noexcept {
        constexpr std::uint32_t SETUP_OPEN = 1U << 7U;
        const std::uint32_t start = transfer_start(channel.timer);
        switch (type_.gtag) {
        case Gtag::SSI:
            registers.request(channel.control,
                              ssi_control(channel.khz, channel.bits, channel.timer, clocks_));
            break;
        case Gtag::BISS:
            registers.request(channel.setup, biss_control(channel.khz, channel.bits, clocks_));
            registers.request(channel.control, start);
            break;
        default:
            registers.request(channel.open, start | SETUP_OPEN);
            registers.request(channel.length, fanuc_bits(channel.bits, clocks_));
            registers.request(channel.setup, fanuc_control(channel.khz, channel.filter, clocks_));
            registers.request(channel.control, start);
            break;
        }
        channel.sent_khz = channel.khz;
        channel.sent_timer = channel.timer;
        channel.sent_filter = channel.filter;
        channel.sent = true;
    }

    UsedModule module_;
    Type type_;
    Clocks clocks_;
    std::map<int, std::string> formats_;
    bool has_timer_, triggered_ = false;
    std::deque<Channel> channels_;  // pins point into it
    PinBinding binding_;
    ReadHandle busy_;
    WriteHandle start_;
};

}  // namespace

std::unique_ptr<Module> make_absolute_encoders(const ModuleRequest &request) {
    const auto *type = std::ranges::find(TYPES, request.module.descriptor.gtag, &Type::gtag);
    return type == std::end(TYPES) ? nullptr : std::make_unique<AbsoluteEncoders>(request, *type);
}

}  // namespace mw::mesa
