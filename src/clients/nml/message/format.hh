// SPDX-License-Identifier: GPL-2.0-or-later
// What update functions see of an encoding: one visitor that puts values into bytes or takes them out, in the
// same order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "messages/declarations/describe.hh"

namespace mw::nml {

/// The frame before every message.
struct FrameHead {
    int number = 0;
    /// Of names and types of all fields: two programs that declare a message otherwise notice it.
    std::uint32_t shape = 0;
    std::string_view name;
};

/// A value and its place in the message.
struct Value {
    const messages::Field &field;
    std::size_t index;  ///< of a series
};

/// Each function returns false when the bytes do not have what is asked for; problem() says why.
class Format {
  public:
    virtual ~Format() = default;
    /// Values are taken out of bytes.
    virtual bool isReading() const = 0;
    /// A form without a number for the shape leaves it 0.
    virtual bool head(FrameHead &head) = 0;
    virtual bool integer(const Value &value, std::int64_t &number) = 0;
    virtual bool real(const Value &value, double &number) = 0;
    /// Of at most `longest` bytes. What was read stays until the next call.
    virtual bool text(const Value &value, std::string_view &text, std::size_t longest) = 0;
    /// Entries of a list.
    virtual bool count(const Value &value, std::uint32_t &count) = 0;
    /// Between them come the values of a struct within the message.
    virtual void enter(const Value &) {}
    virtual void leave() {}
    /// Of the message. What is read must be at its end.
    virtual bool end() = 0;

    const std::string &problem() const { return problem_; }

  protected:
    bool refuse(std::string problem) {
        problem_ = std::move(problem);
        return false;
    }

  private:
    std::string problem_;
};

/// Shows every field to the format, in the order of its declaration; on reading they get the values. An error
/// names message and field.
Result<> update(Format &format, const messages::Object &message);

/// For FrameHead.
std::uint32_t shape_of(const messages::Declaration &head, const messages::Declaration &body);

}  // namespace mw::nml
