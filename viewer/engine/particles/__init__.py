"""Particle systems on the GPU: where particles come from, what moves them, what they meet, how they look.

Each file holds one part, the parameters that an artist sets for it beside the code that they steer. A scene's
``Params`` inherits from those that it wants, and its ``ParticleSystem`` does the rest.
"""
