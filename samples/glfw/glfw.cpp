// SPDX-License-Identifier: Apache-2.0
// A million snowflakes on a collider, in a GLFW window: glfw COLLIDER.relief
#include <GLFW/glfw3.h>

#include <runtime/picture/collider_renderer.h>
#include <runtime/picture/particle_renderer.h>
#include <cstdio>
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
    glfwInit();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* window = glfwCreateWindow(1280, 720, "Relief", nullptr, nullptr);
    glfwMakeContextCurrent(window);
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
    need(snow.setType({.friction = 1.0F}));
    relief::EmitterSettings sky;
    sky.box_min = center + glm::vec3(-size, size, -size);
    sky.box_max = center + glm::vec3(size, 1.2F * size, size);
    sky.rate = 100'000.0;
    sky.lifetime_min = sky.lifetime_max = 10.0F;
    relief::Emitter emitter(sky, 1);
    relief::Camera camera{.eye = center + size * glm::vec3(0.8F, 0.5F, 2.2F), .target = center};
    relief::setClipPlanes(camera, body.bounds);
    const long frames = argc > 2 ? std::stol(argv[2]) : -1;  // -1: no limit
    for (long frame = 0; frame != frames && !glfwWindowShouldClose(window); ++frame) {
        std::vector<relief::Birth> births;
        emitter.emit(1.0 / 60.0, snow.room(), births);
        need(snow.spawn(births));
        need(snow.step(1.0F / 60.0F));
        relief::RenderTarget target{.srgb = true};
        glfwGetFramebufferSize(window, &target.width, &target.height);
        need(body_picture.draw(camera, {}, target));
        need(snow_picture.draw(snow, camera, {.diameter = 0.004F * size}, target));
        glfwSwapBuffers(window);
        glfwPollEvents();
    }
    std::printf("%u particles\n", snow.counts().alive);
}
