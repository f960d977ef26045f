// A million snowflakes on a collider, in a window of SDL2: sdl2 COLLIDER.relief
#include <SDL.h>

#include <cstdio>
#include <cstdlib>
#include <relief/relief.hpp>
#include <stdexcept>

template <class Result>
Result need(Result result) {
    if (!result) {
        throw std::runtime_error(result.error().message);
    }
    return result;
}

int main(int argc, char** argv) {
    SDL_Init(SDL_INIT_VIDEO);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
    SDL_Window* window =
        SDL_CreateWindow("Relief", 0, 0, 1280, 720, SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE);
    SDL_GL_CreateContext(window);
    const relief::Collider body = *need(relief::loadCollider(argc > 1 ? argv[1] : "bunny.relief"));
    const auto textures = *need(relief::ColliderTextures::create(body));
    const relief::ColliderView view{&textures, body.bounds, relief::finestTexel(body)};
    auto body_picture = *need(relief::ColliderRenderer::create(view));
    auto snow_picture = *need(relief::ParticleRenderer::create(view));
    auto snow = *need(relief::ParticleSystem::create({.capacity = 1 << 20}));
    need(snow.setCollider(&textures));
    const float size = body.bounds.longestSide();
    const glm::vec3 center = body.bounds.center();
    need(snow.setForces({.gravity = {0.0F, -0.3F * size, 0.0F}, .drag = 2.5F}));
    need(snow.setCollision({.restitution = 0.0F, .friction = 1.0F}));
    relief::EmitterSettings sky;
    sky.box_min = center + glm::vec3(-size, size, -size);
    sky.box_max = center + glm::vec3(size, 1.2F * size, size);
    sky.rate = 100'000.0;
    sky.lifetime_min = sky.lifetime_max = 10.0F;
    relief::Emitter emitter(sky, 1);
    relief::Camera camera{.eye = center + size * glm::vec3(0.8F, 0.5F, 2.2F), .target = center};
    relief::setClipPlanes(camera, body.bounds);
    long frames = argc > 2 ? std::atol(argv[2]) : -1;  // without end
    for (SDL_Event event{}; event.type != SDL_QUIT && frames != 0; --frames) {
        std::vector<relief::Birth> births;
        emitter.emit(1.0 / 60.0, snow.room(), births);
        need(snow.spawn(births));
        need(snow.step(1.0F / 60.0F));
        relief::RenderTarget target{.srgb = true};
        SDL_GL_GetDrawableSize(window, &target.width, &target.height);
        need(body_picture.draw(camera, {}, target));
        need(snow_picture.draw(snow, camera, {.diameter = 0.004F * size}, target));
        SDL_GL_SwapWindow(window);
        while (SDL_PollEvent(&event) != 0 && event.type != SDL_QUIT) {
        }
    }
    std::printf("%u particles\n", snow.counts().alive);
}
