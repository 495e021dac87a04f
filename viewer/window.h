// A window with Dear ImGui in it: GLFW and OpenGL, on a desktop or in a page of a browser.
#pragma once

#include <string>

#include "workbench.h"

struct GLFWwindow;

namespace ductile::viewer {

/// What differs between the two: desktop.cpp and page.cpp each have their own.
namespace platform {
/// Hints for glfwCreateWindow.
void ask_for(double scale, bool visible);
/// Of the units that GLFW and Dear ImGui count in: pixels per pixel at scale 1.
double scale_of(GLFWwindow* window);
extern const char* const shading_language;
}  // namespace platform

class Window {
 public:
  /// `scale`: pixels per pixel of 1280 × 720; 0: as the display asks for. What is dropped on it is opened.
  Window(Workbench& bench, double scale, bool visible);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return window_; }
  double scale() const { return scale_; }
  bool closing() const;
  void stay();
  void title(const std::string& text);
  /// Takes what the user did; `idle`: waits for it, a little.
  void begin(bool idle);
  /// Puts what was drawn on the screen.
  void end();
  void swap();

 private:
  void dress() const;

  struct Library {
    Library();
    ~Library();
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
  } library_;
  GLFWwindow* window_ = nullptr;
  double scale_ = 1;
};

}  // namespace ductile::viewer
