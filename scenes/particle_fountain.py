"""x"""
from viewer.engine.particles.system import ParticleSystem, ParticleParameters
from viewer import Scene, Orbit, Studio
import moderngl
class ParticleFountain(Scene):
    """Particles."""
    class Params(ParticleParameters): pass
    camera = Orbit(yaw=28, pitch=16, distance=8)
    studio = Studio(radius=4, ground=0.0)
    def __init__(self, gpu, params):
        self.system=ParticleSystem(gpu, params)
        self.system.begin()
    def update(self, dt): self.system.update()
    def prepare(self): self.system.prepare(); self.system.at_beginning and self.system.begin()
    def steered_by(self): return self.system.steered_by()
    def snapshot(self): return self.system.snapshot()
    def restore(self, s): self.system.restore(s)
    def draw(self): pass
    def geometry(self): return self.system.arrays()
    def measure(self): 
        t=self.system.tally; a=self.system.arrays(); k,p,f=self.system.energies(a)
        return dict(alive=len(a['age']), emitted=t.emitted, died=t.died, collisions=t.collisions, children=t.children, kinetic_energy=k, potential_energy=p, fastest=f, step_ms=self.system.step_ms, refused=t.refused)
