// sim/view/png.cpp
// libpng's simplified interface.
#include "sim/view/png.h"

#include "sim/view/window.h"

#include <png.h>

namespace view {

void write_png(const std::string& path, std::span<const std::uint8_t> rgb, int width_px,
               int height_px) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width_px);
    image.height = static_cast<png_uint_32>(height_px);
    image.format = PNG_FORMAT_RGB;
    if (png_image_write_to_file(&image, path.c_str(), 0, rgb.data(), -3 * width_px, nullptr) == 0)
        throw WindowError(path + ": cannot write the picture: " + image.message);
}

} // namespace view
