// SPDX-License-Identifier: GPL-2.0-or-later
// Questions and notes of HAL pins to the operator: [DISPLAY]MESSAGE_... and MULTIMESSAGE_...
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hh"
#include "hal/core/user_pin.hh"

namespace mw::screen {

struct DialogKind {
    bool isOk = false;       ///< the operator closes it
    bool isYesNo = false;    ///< the operator answers it
    bool isLasting = false;  ///< shown while its pin is TRUE
    bool isStatus = false;   ///< also added as a note
};

/// One text of a pin.
struct DialogFacts {
    std::string id;  ///< name of the pin after the component's prefix
    /// MULTIMESSAGE: the value at which it is shown; 0: the pin is a bit.
    std::int32_t number = 0;
    DialogKind kind;
    std::string title, text, details, icon;
};

/// Component `screen`: for each id a pin ID (bit or s32, in and out), ID-waiting (bit, out: the operator is
/// asked) and ID-response (bit, out: the last answer was yes, or it was closed). The operator's answer sets
/// ID to FALSE or 0.
class Dialogs {
  public:
    static constexpr const char *COMPONENT = "screen";

    explicit Dialogs(std::vector<DialogFacts> facts) : facts_(std::move(facts)) {}
    ~Dialogs();
    Dialogs(const Dialogs &) = delete;
    Dialogs &operator=(const Dialogs &) = delete;

    /// Creates the pins in the HAL of a running machine; an error if another screen has them.
    Result<> begin(hal::Instance &hal);
    /// Called when HAL has ended, and its pins with it.
    void leave() { hal_ = nullptr; }
    bool isReady() const { return hal_ != nullptr; }

    /// Reads the pins. Returns the active questions, by their index in `facts`.
    const std::vector<std::size_t> &look();
    /// Notes since the last call.
    std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }
    /// The operator's answer to a question; false if it is no longer shown.
    bool answer(const std::string &id, std::int32_t number, bool isYes);
    const std::vector<DialogFacts> &facts() const { return facts_; }

  private:
    struct RequestOrigin {
        std::string id;
        bool isNumbered = false;
        hal::UserPin<bool> bit{}, waiting{}, response{};
        hal::UserPin<std::int32_t> number{};
        std::int32_t last = 0;      ///< value; 0 or 1 for a bit
        std::int32_t answered = 0;  ///< answered value, until the pin has another one, so that a constant
                                    ///< value asks only once
        bool isAsking = false;

        std::int32_t value() const { return isNumbered ? number.get() : bit.get() ? 1 : 0; }
    };
    static void set_zero(RequestOrigin &asker) {
        asker.isNumbered ? asker.number.set(0) : asker.bit.set(false);
    }
    const DialogFacts *facts_of(const RequestOrigin &asker, std::int32_t value, std::size_t &place) const;

    std::vector<DialogFacts> facts_;
    std::vector<RequestOrigin> askers_;
    std::vector<std::size_t> asked_;
    std::vector<std::string> notes_;
    hal::Instance *hal_ = nullptr;
    int component_ = 0;
};

}  // namespace mw::screen
