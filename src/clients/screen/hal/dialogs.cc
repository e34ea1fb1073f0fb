// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/hal/dialogs.hh"

#include <algorithm>

namespace mw::screen {

using hal::Dir;

Dialogs::~Dialogs() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->components().remove(component_));  // nothing to do if HAL has ended
    }
}

Result<> Dialogs::begin(hal::Instance &hal) {
    const auto made = hal.components().create(COMPONENT);
    if (!made.has_value()) {
        return std::unexpected(made.error());
    }
    component_ = *made;
    askers_.clear();
    asked_.clear();
    for (const DialogFacts &one : facts_) {
        if (std::ranges::find(askers_, one.id, &RequestOrigin::id) == askers_.end()) {
            askers_.push_back({.id = one.id, .isNumbered = one.number != 0});
        }
    }
    Result<> status;
    for (RequestOrigin &asker : askers_) {
        const std::string name = std::string(COMPONENT) + '.' + asker.id;
        if (asker.isNumbered) {
            asker.number.make(hal, component_, name, Dir::IO, status);
        } else {
            asker.bit.make(hal, component_, name, Dir::IO, status);
        }
        asker.waiting.make(hal, component_, name + "-waiting", Dir::OUT, status);
        asker.response.make(hal, component_, name + "-response", Dir::OUT, status);
    }
    if (status.has_value()) {
        status = hal.components().set_ready(component_);
    }
    if (!status.has_value()) {
        static_cast<void>(hal.components().remove(component_));
        return status;
    }
    hal_ = &hal;
    return {};
}

const DialogFacts *Dialogs::facts_of(const RequestOrigin &asker, std::int32_t value,
                                     std::size_t &place) const {
    for (place = 0; place < facts_.size(); ++place) {
        const DialogFacts &one = facts_[place];
        if (one.id == asker.id && value != 0 && (one.number == 0 || one.number == value)) {
            return &one;
        }
    }
    return nullptr;
}

const std::vector<std::size_t> &Dialogs::look() {
    asked_.clear();
    if (hal_ == nullptr) {
        return asked_;
    }
    for (RequestOrigin &asker : askers_) {
        const std::int32_t value = asker.value();
        std::size_t place = 0;
        const DialogFacts *const now = facts_of(asker, value, place);
        const bool is_new = value != asker.last;
        asker.last = value;
        if (is_new && now != nullptr && now->kind.isStatus) {
            notes_.push_back(now->title.empty() ? now->text : now->title + ": " + now->text);
        }
        asker.answered = value == asker.answered ? value : 0;
        const bool is_open = now != nullptr && asker.answered == 0;
        const bool is_person = is_open && (now->kind.isOk || now->kind.isYesNo);
        if (is_new && is_person) {
            asker.response = false;
        }
        asker.isAsking = is_person;
        asker.waiting = is_person;
        if (value != 0 && now == nullptr) {
            if (is_new) {
                notes_.push_back(std::string(COMPONENT) + '.' + asker.id + " is " + std::to_string(value) +
                                 ", and [DISPLAY] has no MULTIMESSAGE with this number");
            }
            set_zero(asker);  // HAL must not wait for an answer to a question that nobody sees
        }
        if (is_person || (is_open && now->kind.isLasting)) {
            asked_.push_back(place);
        } else if (is_open && now->kind.isStatus) {
            set_zero(asker);  // told
        }
    }
    return asked_;
}

bool Dialogs::answer(const std::string &id, std::int32_t number, bool is_yes) {
    const auto found = std::ranges::find(askers_, id, &RequestOrigin::id);
    if (hal_ == nullptr || found == askers_.end() || !found->isAsking) {
        return false;
    }
    const std::int32_t value = found->value();
    if (found->isNumbered && value != number) {
        return false;  // it shows another question now
    }
    found->response = is_yes;
    found->isAsking = false;
    found->waiting = false;
    found->answered = value;
    set_zero(*found);
    return true;
}

}  // namespace mw::screen
