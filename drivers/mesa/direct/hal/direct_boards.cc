// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/direct/hal/direct_boards.hh"

#include <algorithm>
#include <cerrno>
#include <vector>

#include <fmt/format.h>

#include "drivers/mesa/direct/direct_pins.hh"
#include "drivers/mesa/hostmot2/forwarding_bus.hh"

namespace mw::mesa {

namespace {

/// A bus whose fault is shown by a parameter.
class PinnedBus final : public ForwardingBus {
  public:
    PinnedBus(std::unique_ptr<DirectBus> bus, DirectPins &pins)
        : ForwardingBus(*bus), bus_(std::move(bus)), pins_(pins) {}

    CycleRead read(std::span<std::uint32_t> values, long period_ns) noexcept override {
        pins_.before(*bus_);
        const CycleRead result = bus_->read(values, period_ns);
        pins_.after(*bus_);
        return result;
    }
    bool write(std::span<const RegisterWrite> writes) noexcept override {
        const bool done = bus_->write(writes);
        if (!done) {
            pins_.after(*bus_);
        }
        return done;
    }

  private:
    std::unique_ptr<DirectBus> bus_;
    DirectPins &pins_;
};

struct DirectBoard {
    int comp_id = 0;
    std::string card;
    std::unique_ptr<PinnedBus> bus;
};

std::vector<DirectBoard> &boards() {
    static std::vector<DirectBoard> all;
    return all;
}

}  // namespace

int add_direct_board(DirectBoardRequest request) {
    const std::string card = request.card.hal_name;
    auto bus = DirectBus::open(std::move(request.access), std::move(request.card), request.place);
    if (!bus) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s\n", request.module.c_str(), bus.error().str().c_str());
        return -ENODEV;
    }
    auto *const pins = sdk::make<DirectPins>();
    if (pins == nullptr) {
        return -ENOMEM;
    }
    const auto number = std::ranges::count(boards(), card, &DirectBoard::card);
    const std::string name = fmt::format("hm2_{}.{}", card, number);
    rtapi_print_msg(RTAPI_MSG_INFO, "%s: %s at %s\n", request.module.c_str(), name.c_str(),
                    request.place.c_str());
    boards().push_back({request.comp_id, card, std::make_unique<PinnedBus>(std::move(*bus), *pins)});
    if (const int status = register_board({request.comp_id, name, boards().back().bus.get(), request.config});
        status != 0) {
        return status;
    }
    sdk::Declare declare(request.comp_id, name.c_str(), static_cast<int>(number));
    pins->declare(declare);
    return declare.status();
}

void remove_direct_boards(int comp_id) {
    unregister_boards(comp_id);
    std::erase_if(boards(), [&](const DirectBoard &board) { return board.comp_id == comp_id; });
}

std::string text_at(std::span<char *const> texts, std::size_t index) {
    return index < texts.size() && texts[index] != nullptr ? texts[index] : "";
}

}  // namespace mw::mesa
