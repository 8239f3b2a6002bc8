"""A class in the browser (`serve`): students fill in answer sheets, instructors mark them; the folder keeps all."""
