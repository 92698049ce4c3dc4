/* A step of a mesh from C99: a triangle falls through a resting one. */

#include <stdio.h>
#include <touchstone/touchstone.h>

int main(void) {
  const double before[18] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 3, 1, 1, 1, 3, 1};
  const double after[18] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -2, 3, 1, -2, 1, 3, -2};
  const int32_t faces[6] = {0, 1, 2, 3, 4, 5};
  TouchstoneMesh mesh = {0};
  mesh.vertices = 6;
  mesh.before = before;
  mesh.after = after;
  mesh.faces = 2;
  mesh.face_vertices = faces;

  TouchstoneStep* step = touchstone_step_new(&mesh, NULL);
  const TouchstoneCollision* collisions = NULL;
  size_t count = 0;
  if (step == NULL || touchstone_step_collisions(step, &collisions, &count) != 0) {
    fprintf(stderr, "%s\n", touchstone_last_error());
    return 2;
  }
  for (size_t i = 0; i < count; ++i) {
    printf("kind %d: %d and %d from t = %.17g\n", (int)collisions[i].kind, (int)collisions[i].first,
           (int)collisions[i].second, collisions[i].toi_lower);
  }
  touchstone_step_free(step);
  return count > 0 ? 1 : 0;
}
