// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/eval/parameters.hh"

#include <algorithm>

namespace mw::interp::detail {

Parameters::Parameters() : values_(PARAMETER_COUNT, 0.0), frames_(1) {
    values_[P_COORDINATE_SYSTEM] = 1;
    values_[P_DEBUG_SHOWN] = 1;
}

void Parameters::set(int number, double value) {
    double &slot = values_[static_cast<std::size_t>(number)];
    log_.push_back({Undo::Kind::NUMBER, number, NO_ID, slot});
    slot = value;
}

std::optional<double> Parameters::named(NameId id, bool isGlobal) const {
    if (isGlobal) {
        return id < globals_.size() ? globals_[id] : std::nullopt;
    }
    for (const Named &local : frames_[depth_ - 1].locals) {
        if (local.id == id) {
            return local.value;
        }
    }
    return std::nullopt;
}

void Parameters::set_named(NameId id, bool isGlobal, double value) {
    if (isGlobal) {
        if (id >= globals_.size()) {
            globals_.resize(id + 1);
        }
        log_.push_back({Undo::Kind::GLOBAL, 0, id, globals_[id]});
        globals_[id] = value;
        return;
    }
    std::vector<Named> &locals = frames_[depth_ - 1].locals;
    for (Named &local : locals) {
        if (local.id == id) {
            log_.push_back({Undo::Kind::LOCAL, 0, id, local.value});
            local.value = value;
            return;
        }
    }
    log_.push_back({Undo::Kind::LOCAL, 0, id, std::nullopt});
    locals.push_back({id, value});
}

void Parameters::forget_names() {
    globals_.clear();
    frames_[depth_ - 1].locals.clear();
    log_.clear();
}

void Parameters::push_call() {
    if (depth_ == frames_.size()) {
        frames_.emplace_back();
    }
    Frame &frame = frames_[depth_++];
    frame.locals.clear();
    frame.more.clear();
    std::copy_n(values_.begin() + 1, ARGUMENT_COUNT, frame.arguments);
}

void Parameters::set_arguments(std::span<const double> given) {
    std::ranges::copy(given, values_.begin() + 1);
}

void Parameters::keep_aside(std::size_t count) {
    const auto first = values_.begin() + 1 + ARGUMENT_COUNT;
    frames_[depth_ - 1].more.assign(first, first + static_cast<std::ptrdiff_t>(count) - ARGUMENT_COUNT);
}

void Parameters::pop_call(bool isSharing) {
    const Frame &frame = frames_[--depth_];
    std::ranges::copy(frame.more, values_.begin() + 1 + ARGUMENT_COUNT);
    if (!isSharing) {
        std::copy_n(frame.arguments, ARGUMENT_COUNT, values_.begin() + 1);
    }
}

std::vector<std::pair<NameId, double>> Parameters::locals(int level) const {
    std::vector<std::pair<NameId, double>> out;
    for (const Named &local : frames_[static_cast<std::size_t>(level)].locals) {
        out.emplace_back(local.id, local.value);
    }
    return out;
}

std::vector<std::pair<NameId, double>> Parameters::globals() const {
    std::vector<std::pair<NameId, double>> out;
    for (std::size_t id = 0; id < globals_.size(); ++id) {
        if (globals_[id]) {
            out.emplace_back(static_cast<NameId>(id), *globals_[id]);
        }
    }
    return out;
}

std::array<double, ARGUMENT_COUNT> Parameters::saved_arguments(int level) const {
    std::array<double, ARGUMENT_COUNT> out{};
    std::ranges::copy(frames_[static_cast<std::size_t>(level)].arguments, out.begin());
    return out;
}

void Parameters::rollback() {
    for (auto entry = log_.rbegin(); entry != log_.rend(); ++entry) {
        if (entry->kind == Undo::Kind::NUMBER) {
            values_[static_cast<std::size_t>(entry->number)] = *entry->old;
        } else if (entry->kind == Undo::Kind::GLOBAL) {
            globals_[entry->id] = entry->old;
        } else {
            std::vector<Named> &locals = frames_[depth_ - 1].locals;
            const auto found = std::find_if(locals.begin(), locals.end(),
                                            [&](const Named &local) { return local.id == entry->id; });
            if (found != locals.end() && entry->old) {
                found->value = *entry->old;
            } else if (found != locals.end()) {
                locals.erase(found);
            }
        }
    }
    log_.clear();
}

}  // namespace mw::interp::detail
