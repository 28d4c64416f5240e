"""Pictures of a physical medium by path tracing: slow, and the truth that the shader is compared with."""
