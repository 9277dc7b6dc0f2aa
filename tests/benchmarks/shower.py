"""The shower of particles that everybody steps, without importing the viewer: what it is, by number.

A nozzle at the origin sends particles upwards within a cone. They fall under gravity and drag, and bounce off the
ground, y = 0, and off a ball above the nozzle. Whoever's time is up is sent off anew.
"""

from __future__ import annotations

STEP = 1.0 / 60.0               # seconds
GRAVITY = 9.81
DRAG = 0.1
RESTITUTION = 0.5
FRICTION = 0.2
BALL_HEIGHT, BALL_RADIUS = 1.0, 0.5
SPEED = 7.0, 8.0
LIFETIME = 2.0, 3.0
SPREAD = 25.0                   # degrees
MANY = 1 << 20
STEADY = 200                    # steps after which as many die as are born
