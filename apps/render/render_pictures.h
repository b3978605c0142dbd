#pragma once

#include "render/render.h"

namespace app {

/// Draws picture.png, or film.mp4, or without ffmpeg the film's pictures frame_0001.png, …
ExitStatus drawPictures(const RenderOptions& options, const CommandContext& context);

}  // namespace app
