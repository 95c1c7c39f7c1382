"""The gallery and the contact sheets: strips of captioned stills that show what each part does."""
