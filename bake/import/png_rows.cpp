// SPDX-License-Identifier: Apache-2.0
#include "bake/import/image_rows.h"

#include <png.h>

#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/text.h"

namespace relief {
namespace {

/// libpng reports errors with longjmp, so functions here that call setjmp have no local objects with destructors.
class PngRows : public SampleRows {
  public:
    explicit PngRows(std::span<const std::byte> bytes) : left_(bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngRows::onError, &PngRows::onWarning);
        info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
    }
    ~PngRows() override { png_destroy_read_struct(&png_, &info_, nullptr); }

    Result<void> open() {
        if (info_ == nullptr || !readHeader()) {
            return unreadable();
        }
        const int colour = png_get_color_type(png_, info_);
        const int bits = png_get_bit_depth(png_, info_);
        if ((colour & PNG_COLOR_MASK_PALETTE) != 0 || bits < 8) {
            const char* const kind = bits < 8 ? "an image of fewer than 8 bits" : "an image with a palette";
            return fail(ErrorCode::kUnsupported,
                        std::string("it is ") + kind + "; save it as 16-bit grey, without alpha");
        }
        channels_ = png_get_channels(png_, info_);
        if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE) {
            return fail(ErrorCode::kUnsupported,
                        "it is interlaced, so it cannot be read row by row; save it without interlacing");
        }
        columns_ = png_get_image_width(png_, info_);
        rows_ = png_get_image_height(png_, info_);
        most_ = bits == 16 ? 65535 : 255;
        readHole();
        return {};
    }

    Result<void> next(std::span<float> out) override {
        row_.resize(columns_ * channels_ * (most_ > 255 ? 2 : 1));
        if (!readRow()) {
            return unreadable();
        }
        for (std::size_t i = 0; i < out.size(); ++i) {
            const std::uint32_t grey = sampleAt(i * channels_);
            RELIEF_TRY(checkColour(i, grey));
            out[i] = grey == hole_ ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(grey);
        }
        ++row_number_;
        return {};
    }

  private:
    /// Reads the colour that a tRNS chunk makes transparent. With 8-bit samples, only the low byte is used.
    void readHole() {
        png_color_16p key = nullptr;
        if (png_get_tRNS(png_, info_, nullptr, nullptr, &key) == 0 || key == nullptr) {
            return;
        }
        const bool grey = channels_ < 3;
        if (grey || (key->red == key->green && key->red == key->blue)) {
            hole_ = std::uint32_t{grey ? key->gray : key->red} & most_;
        }
    }

    [[nodiscard]] std::uint32_t sampleAt(std::size_t i) const {
        return most_ > 255 ? std::uint32_t{row_[2 * i]} << 8U | row_[2 * i + 1] : std::uint32_t{row_[i]};
    }

    /// Checks that a pixel is grey. Many programs save grey as equal red, green and blue, with opaque alpha.
    [[nodiscard]] Result<void> checkColour(std::size_t column, std::uint32_t grey) const {
        const std::size_t first = column * channels_;
        const bool coloured = channels_ >= 3 && (sampleAt(first + 1) != grey || sampleAt(first + 2) != grey);
        const bool transparent = channels_ % 2 == 0 && sampleAt(first + channels_ - 1) != most_;
        if (!coloured && !transparent) {
            return {};
        }
        return fail(ErrorCode::kUnsupported,
                    std::string("it is ") + (coloured ? "in colour" : "transparent") + " at column " +
                        std::to_string(column) + " of row " + std::to_string(row_number_) +
                        "; save it as 16-bit grey, without alpha");
    }

    bool readHeader() {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_set_read_fn(png_, this, &PngRows::onRead);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_read_info(png_, info_);
        return true;
    }

    bool readRow() {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_read_row(png_, row_.data(), nullptr);
        return true;
    }

    [[nodiscard]] tl::unexpected<Error> unreadable() const {
        return invalidInput("it cannot be read as PNG: " + oneCleanLine(message_.data()) + "; save it again");
    }

    static void onError(png_structp png, png_const_charp message) {
        auto& self = *static_cast<PngRows*>(png_get_error_ptr(png));
        std::strncpy(self.message_.data(), message, self.message_.size() - 1);
        png_longjmp(png, 1);
    }
    static void onWarning(png_structp /*png*/, png_const_charp /*message*/) {}
    static void onRead(png_structp png, png_bytep out, png_size_t size) {
        auto& self = *static_cast<PngRows*>(png_get_io_ptr(png));
        if (size > self.left_.size()) {
            png_error(png, "it is cut off");
        }
        std::memcpy(out, self.left_.data(), size);
        self.left_ = self.left_.subspan(size);
    }

    std::span<const std::byte> left_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::vector<png_byte> row_;
    std::size_t channels_ = 1;
    std::optional<std::uint32_t> hole_;
    std::uint64_t row_number_ = 0;
    std::array<char, 128> message_{};
};

}  // namespace

Result<std::unique_ptr<SampleRows>> openPngRows(std::span<const std::byte> bytes) {
    auto rows = std::make_unique<PngRows>(bytes);
    RELIEF_TRY(rows->open());
    return std::unique_ptr<SampleRows>(std::move(rows));
}

Result<std::unique_ptr<SampleRows>> openImageRows(std::span<const std::byte> bytes) {
    return isPng(bytes) ? openPngRows(bytes) : openExrRows(bytes);
}

}  // namespace relief
