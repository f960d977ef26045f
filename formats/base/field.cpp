// SPDX-License-Identifier: Apache-2.0
#include "formats/base/field.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>

namespace relief {
namespace {

static_assert(std::endian::native == std::endian::little);  // whole numbers are copied as their low bytes

template <class T>
T load(const void* value) {
    T number{};
    std::memcpy(&number, value, sizeof(T));
    return number;
}

template <class T>
void store(void* to, double value) {
    const T number = static_cast<T>(value);
    std::memcpy(to, &number, sizeof(T));
}

}  // namespace

std::string rangeAdvice(const FieldRange& range, std::string (*text)(double)) {
    const std::string low = text(range.low);
    if (!std::isfinite(range.high)) {
        return range.low_included ? "choose " + low + " or more" : "choose more than " + low;
    }
    return (range.low_included ? "choose " + low + " to " : "choose more than " + low + ", up to ") +
           text(range.high);
}

FieldVisitor::~FieldVisitor() = default;

FieldRef FieldRef::valueOrDefault() const {
    if (form() != FieldForm::kOptional) {
        return *this;
    }
    return count() == 0 ? FieldRef(type_->held->blank(), *type_->held) : (*this)[0];
}

std::size_t FieldRef::count() const {
    return type_->items == nullptr ? type_->count : type_->items(value_).count;
}

FieldRef FieldRef::operator[](std::size_t i) const {
    void* const first = type_->items == nullptr ? value_ : type_->items(value_).first;
    return {static_cast<char*>(first) + i * type_->held->size, *type_->held};
}

void FieldRef::visit(FieldVisitor& visitor) const {
    if (form() == FieldForm::kGroup) {
        const auto& group = as<const FieldGroup>();
        group.visit(group.of, visitor);
        return;
    }
    type_->fields(visitor, value_);
}

bool FieldRef::isNumber() const {
    return form() == FieldForm::kUnsigned || form() == FieldForm::kSigned || form() == FieldForm::kReal;
}

std::uint64_t FieldRef::whole() const {
    std::uint64_t value = 0;
    assert(type_->size <= sizeof(value));
    std::memcpy(&value, value_, type_->size);
    return value;
}

std::int64_t FieldRef::integer() const {
    const auto unused = static_cast<int>(64 - 8 * type_->size);
    return static_cast<std::int64_t>(whole() << unused) >> unused;  // extends the sign
}

double FieldRef::number() const {
    if (form() == FieldForm::kReal) {
        return type_->size == sizeof(float) ? double{load<float>(value_)} : load<double>(value_);
    }
    return form() == FieldForm::kSigned ? static_cast<double>(integer()) : static_cast<double>(whole());
}

void FieldRef::setWhole(std::uint64_t value) const {
    assert(type_->size <= sizeof(value));
    std::memcpy(value_, &value, type_->size);
}

void FieldRef::setReal(double value) const {
    type_->size == sizeof(float) ? store<float>(value_, value) : store<double>(value_, value);
}

bool FieldRef::isText() const {
    return form() == FieldForm::kString || form() == FieldForm::kText || form() == FieldForm::kPath;
}

std::string_view FieldRef::text() const {
    return form() == FieldForm::kString ? std::string_view(as<const std::string>())
           : form() == FieldForm::kPath ? std::string_view(as<const std::filesystem::path>().native())
                                        : type_->text(value_);
}

bool FieldRef::setWord(std::string_view word) const {
    const auto found = std::find(type_->words.begin(), type_->words.end(), word);
    if (found == type_->words.end()) {
        return false;
    }
    setWhole(static_cast<std::uint64_t>(found - type_->words.begin()));
    return true;
}

}  // namespace relief
