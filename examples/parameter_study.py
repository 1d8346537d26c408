"""A parameter study: how far an annulus with a 3 and a 5 is from a valid configuration.

Where the valence 5 is turned by phi against the valence 3, the field misses the inner circle by
phi / 4. That is all there is to it: the radii do not matter.
"""

import matplotlib.pyplot as plt
import numpy as np

import crossview
from crossview import Problem, Singularity, primitives

surface = primitives.annulus(inner=0.4, n=72)
three = Singularity(surface.closest_point((0.8, 0, 0)), valence=3)

angles = np.radians(np.arange(10, 360, 25))
defects = []
for angle in angles:
    place = 0.6 * np.array([np.cos(angle), np.sin(angle), 0])
    five = Singularity(surface.closest_point(place), valence=5)
    solution = crossview.solve(Problem(surface, [three, five]))
    defects.append(solution.holonomy_defects[0])

measured, theory = np.degrees(np.abs(defects)), np.degrees(angles) / 4
theory = np.minimum(theory, 90 - theory)  # modulo 90 degrees
print(f"{np.abs(measured - theory).max():.1f}")  # 0.0

figure, axes = plt.subplots()
axes.plot(np.degrees(angles), theory, label="phi / 4, modulo 90")
axes.plot(np.degrees(angles), measured, "o", label="solved")
axes.set(xlabel="angle between the two, degrees", ylabel="holonomy defect, degrees")
axes.legend()
figure.savefig("defects.png", dpi=150)
plt.close(figure)
