// SPDX-License-Identifier: Apache-2.0
#include "formats/base/field.h"

#include <cstring>

namespace relief {
namespace {

template <class T>
T load(const void* value) {
    T number{};
    std::memcpy(&number, value, sizeof(T));
    return number;
}

template <class T, class Value>
void store(void* to, Value value) {
    const T number = static_cast<T>(value);
    std::memcpy(to, &number, sizeof(T));
}

}  // namespace

FieldVisitor::~FieldVisitor() = default;

FieldRef FieldRef::heldOrBlank() const {
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
    switch (type_->size) {
        case 1:
            return load<std::uint8_t>(value_);
        case 2:
            return load<std::uint16_t>(value_);
        case 4:
            return load<std::uint32_t>(value_);
        default:
            return load<std::uint64_t>(value_);
    }
}

std::int64_t FieldRef::integer() const {
    switch (type_->size) {
        case 1:
            return load<std::int8_t>(value_);
        case 2:
            return load<std::int16_t>(value_);
        case 4:
            return load<std::int32_t>(value_);
        default:
            return load<std::int64_t>(value_);
    }
}

double FieldRef::number() const {
    if (form() == FieldForm::kReal) {
        return type_->size == sizeof(float) ? double{load<float>(value_)} : load<double>(value_);
    }
    return form() == FieldForm::kSigned ? static_cast<double>(integer()) : static_cast<double>(whole());
}

void FieldRef::setWhole(std::uint64_t value) const {
    switch (type_->size) {
        case 1:
            return store<std::uint8_t>(value_, value);
        case 2:
            return store<std::uint16_t>(value_, value);
        case 4:
            return store<std::uint32_t>(value_, value);
        default:
            return store<std::uint64_t>(value_, value);
    }
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
